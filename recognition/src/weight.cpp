#include <hoist/recognition/weight.h>

#include <cmath>

namespace hoist {

const std::vector<Material>&
materials()
{
  // EN 1991-1-1:2002 gives weights in kN/m3; 1 kN/m3 = 102 kg/m3.
  static const std::vector<Material> table = {
      {"concrete", 2400, 2300, 2550, "EN 206: normal weight 2000-2600; plain 24 kN/m3"},
      {"reinforced-concrete", 2500, 2400, 2600, "EN 1991-1-1 table A.1: 25 kN/m3"},
      {"lightweight-concrete", 1400, 800, 2000, "EN 206: 800-2000 kg/m3"},
      {"brick", 1800, 1600, 2200, "EN 771-1: clay units, gross, without large holes"},
      {"steel", 7850, 7700, 7850, "EN 1991-1-1 table A.4: 77.0-78.5 kN/m3"},
      {"aluminium", 2700, 2650, 2800, "EN 1991-1-1 table A.4: 27.0 kN/m3"},
      {"glass", 2500, 2450, 2550, "EN 1991-1-1 table A.5: 25.0 kN/m3 (sheets)"},
      {"wood", 420, 350, 700, "EN 338: mean 420 (C24); softwood C14 to hardwood D40"},
      {"plywood", 550, 450, 700, "EN 1991-1-1 table A.3: 5.0-7.0 kN/m3"},
      {"gypsum-board", 800, 650, 1000, "EN 520: boards of 8-10 kg/m2 at 12.5 mm"},
      {"mineral-wool", 100, 20, 200, "EN 13162: usual products"},
      {"carton", 167, 30, 600, "air freight's 6000 cm3/kg; the contents decide"}};
  return table;
}

const Material*
findMaterial(const std::string& name)
{
  for (const Material& material : materials())
    if (name == material.name)
      return &material;
  return nullptr;
}

Weight
estimateWeight(const Cuboid& cuboid, const Material& material)
{
  Weight weight;
  weight.value = cuboid.volume() * material.density;
  const double spread = (material.density_high - material.density_low) /
                        (std::sqrt(12.0) * material.density);
  const double relative =
      (cuboid.size_sigma.array() / cuboid.size.array()).square().sum() +
      spread * spread;
  weight.sigma = weight.value * std::sqrt(relative);
  return weight;
}

} // namespace hoist
