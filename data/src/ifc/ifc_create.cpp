#include <hoist/data/atomic_file.h>
#include <hoist/data/ifc/ifc_edit.h>
#include <hoist/data/ifc/ifc_guid.h>

#include <pcl/exceptions.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace hoist {
namespace {

/// The name space of projects that are made here: a UUID of version 4, drawn once.
constexpr Uuid project_space = {0x6f,
                                0x1c,
                                0x52,
                                0x0d,
                                0x3e,
                                0x9a,
                                0x4b,
                                0x77,
                                0x9d,
                                0x41,
                                0x58,
                                0xe2,
                                0x0b,
                                0xc6,
                                0x93,
                                0xaf};

/// Units of length that a model may have, and the instances that say so. #20 is the
/// unit.
struct LengthUnit {
  double metres;
  const char* lines;
};

constexpr LengthUnit length_units[] = {
    {1, "#20=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n"},
    {0.1, "#20=IFCSIUNIT(*,.LENGTHUNIT.,.DECI.,.METRE.);\n"},
    {0.01, "#20=IFCSIUNIT(*,.LENGTHUNIT.,.CENTI.,.METRE.);\n"},
    {0.001, "#20=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);\n"},
    {0.0254,
     "#17=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);\n"
     "#18=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n"
     "#19=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.0254),#18);\n"
     "#20=IFCCONVERSIONBASEDUNIT(#17,.LENGTHUNIT.,'INCH',#19);\n"},
    {0.3048,
     "#17=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);\n"
     "#18=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n"
     "#19=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.3048),#18);\n"
     "#20=IFCCONVERSIONBASEDUNIT(#17,.LENGTHUNIT.,'FOOT',#19);\n"}};

const char*
unitLines(double metres)
{
  for (const LengthUnit& unit : length_units)
    if (std::abs(unit.metres - metres) < 1e-12)
      return unit.lines;
  PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                      "a model cannot have units of " << metres << " m");
}

std::string
isoTime(std::int64_t seconds)
{
  const auto time = static_cast<std::time_t>(seconds);
  std::tm parts{};
  std::array<char, 64> text{};
  if (::gmtime_r(&time, &parts) == nullptr ||
      std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts) == 0)
    return "1970-01-01T00:00:00";
  return text.data();
}

std::string
coordinates(const Eigen::Vector3d& v)
{
  return '(' + part21Real(v.x(), 15) + ',' + part21Real(v.y(), 15) + ',' +
         part21Real(v.z(), 15) + ')';
}

} // namespace

std::string
newIfcModel(const IfcNewModel& settings)
{
  const std::string unit_lines = unitLines(settings.length_unit);
  const bool old = settings.schema == IfcSchema::ifc2x3;
  const std::string time = std::to_string(settings.time);
  const std::string project = toIfcGuid(nameUuid(project_space, settings.name));
  const auto guid = [&](const char* key) {
    return '\'' + ifcGuidOf(project, key) + '\'';
  };
  Eigen::Isometry3d site = settings.site_pose;
  site.translation() /= settings.length_unit;

  std::string out = "ISO-10303-21;\nHEADER;\n";
  out += std::string("FILE_DESCRIPTION(('ViewDefinition [") +
         (old ? "CoordinationView" : "ReferenceView_V1.2") + "]'),'2;1');\n";
  out += "FILE_NAME(" + encodePart21(settings.name + ".ifc") + ",'" +
         isoTime(settings.time) + "',('hoist'),('hoist'),'hoist','hoist','');\n";
  out += std::string("FILE_SCHEMA(('") + toString(settings.schema) + "'));\n";
  out += "ENDSEC;\nDATA;\n";
  out += "#1=IFCPERSON('hoist',$,$,$,$,$,$,$);\n"
         "#2=IFCORGANIZATION($,'hoist',$,$,$);\n"
         "#3=IFCPERSONANDORGANIZATION(#1,#2,$);\n"
         "#4=IFCAPPLICATION(#2,'0.1','hoist','hoist');\n"
         "#5=IFCOWNERHISTORY(#3,#4,$,.NOCHANGE.,$,$,$," +
         time +
         ");\n"
         "#6=IFCCARTESIANPOINT((0.,0.,0.));\n"
         "#7=IFCDIRECTION((0.,0.,1.));\n"
         "#8=IFCAXIS2PLACEMENT3D(#6,$,$);\n"
         "#9=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,#8,$);\n"
         "#10=IFCGEOMETRICREPRESENTATIONSUBCONTEXT('Body','Model',*,*,*,*,#9,$,.MODEL_"
         "VIEW.,$);\n";
  out += unit_lines;
  out += "#21=IFCSIUNIT(*,.AREAUNIT.,$,.SQUARE_METRE.);\n"
         "#22=IFCSIUNIT(*,.VOLUMEUNIT.,$,.CUBIC_METRE.);\n"
         "#23=IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.);\n"
         "#24=IFCSIUNIT(*,.MASSUNIT.,.KILO.,.GRAM.);\n"
         "#25=IFCUNITASSIGNMENT((#20,#21,#22,#23,#24));\n";
  out += "#30=IFCPROJECT('" + project + "',#5," + encodePart21(settings.name) +
         ",$,$,$,$,(#9),#25);\n";
  out += "#31=IFCCARTESIANPOINT(" + coordinates(site.translation()) +
         ");\n"
         "#32=IFCDIRECTION(" +
         coordinates(site.linear().col(2)) +
         ");\n"
         "#33=IFCDIRECTION(" +
         coordinates(site.linear().col(0)) +
         ");\n"
         "#34=IFCAXIS2PLACEMENT3D(#31,#32,#33);\n"
         "#35=IFCLOCALPLACEMENT($,#34);\n"
         "#36=IFCSITE(" +
         guid("site") + ",#5," + encodePart21(settings.site) +
         ",$,$,#35,$,$,.ELEMENT.,$,$,$,$,$);\n"
         "#37=IFCLOCALPLACEMENT(#35,#8);\n"
         "#38=IFCBUILDING(" +
         guid("building") + ",#5," + encodePart21(settings.building) +
         ",$,$,#37,$,$,.ELEMENT.,$,$,$);\n"
         "#39=IFCLOCALPLACEMENT(#37,#8);\n"
         "#40=IFCBUILDINGSTOREY(" +
         guid("storey") + ",#5," + encodePart21(settings.storey) +
         ",$,$,#39,$,$,.ELEMENT.,0.);\n"
         "#41=IFCRELAGGREGATES(" +
         guid("site/relation") +
         ",#5,$,$,#30,(#36));\n"
         "#42=IFCRELAGGREGATES(" +
         guid("building/relation") +
         ",#5,$,$,#36,(#38));\n"
         "#43=IFCRELAGGREGATES(" +
         guid("storey/relation") + ",#5,$,$,#38,(#40));\n";
  return out + "ENDSEC;\nEND-ISO-10303-21;\n";
}

std::string
ifcModelOf(const std::vector<IfcObject>& objects, const IfcNewModel& settings)
{
  const IfcModel model(Part21File::parse(newIfcModel(settings), settings.name));
  IfcEdit edit(model);
  for (const IfcObject& object : objects)
    edit.put(object);
  return edit.part21().bytes();
}

void
saveIfcModel(const std::filesystem::path& path,
             const std::vector<IfcObject>& objects,
             const IfcNewModel& settings)
{
  writeFileAtomically(path, ifcModelOf(objects, settings));
}

} // namespace hoist
