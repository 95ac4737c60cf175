// libFuzzer target: bytes as a STEP file, as a model, and as a model that a thing is
// put into. Nothing but a LoadError or a BadArgumentException may come of it; what is
// written must be readable again.
#include <hoist/data/ifc/ifc_edit.h>

#include <pcl/exceptions.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  std::string written;
  try {
    const hoist::IfcModel model(
        hoist::Part21File::parse(std::string(data, data + size), "fuzz.ifc"));
    for (const hoist::IfcElement& element : model.elements())
      (void)model.propertySets(element.id);
    hoist::IfcObject object;
    object.key = "fuzz";
    object.box.size = Eigen::Vector3d(0.3, 0.2, 0.1);
    object.rgb = {10, 20, 30};
    object.material = "wood";
    hoist::IfcEdit edit(model);
    edit.put(object);
    written = edit.part21().bytes();
  }
  catch (const hoist::LoadError&) {
    return 0;
  }
  catch (const pcl::BadArgumentException&) {
    return 0;
  }
  try {
    (void)hoist::Part21File::parse(written, "written.ifc").countReferences();
  }
  catch (const hoist::LoadError&) {
    std::abort();
  }
  return 0;
}
