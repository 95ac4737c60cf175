#pragma once

#include <hoist/data/load_error.h>
#include <hoist/recognition/export.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace hoist {

enum class AttributeType { numeric, categorical, boolean };

/** \brief What an attribute of a class is, and how a network says and learns it. */
struct AttributeSpec {
  std::string name;
  AttributeType type = AttributeType::numeric;
  std::vector<std::string> components; ///< numeric: of the vector; empty: one number
  std::vector<std::string> values;     ///< categorical: in the order of the logits
  std::string unit;                    ///< numeric: "m", "sRGB", ...; may be ""
  std::array<double, 2> range{};       ///< numeric: low < high, in \a unit
  std::string encoding;                ///< "linear", "one-hot" or "binary"
  std::string loss;                    ///< "quadratic" or "cross-entropy"
  std::string truth; ///< entry of an annotation that holds the true value

  /** \brief How many numbers a network says it with. */
  std::size_t outputs() const;
};

/** \brief A class of things. */
struct ClassSpec {
  std::string name;
  std::vector<std::size_t> attributes; ///< indices into Ontology::attributes
  bool box_like = false; ///< its shape is a cuboid, which the segmentation can find
};

/** \brief Densities met in practice. */
struct MaterialSpec {
  std::string name;
  std::array<double, 2> density{}; ///< low <= high [kg/m3], > 0
};

/** \brief Which things there are and what can be said of them; read from a file that
 *  the trainer of a network reads too. See data/docs/ontology.md. */
struct Ontology {
  std::string name;
  int version = 1;
  std::vector<MaterialSpec> materials;
  std::vector<AttributeSpec> attributes;
  std::vector<ClassSpec> classes; ///< class i is a network's label i + 1

  /** \brief The one of that name, or nullptr. */
  HOIST_RECOGNITION_EXPORT const ClassSpec*
  findClass(const std::string& class_name) const;
  HOIST_RECOGNITION_EXPORT const AttributeSpec*
  findAttribute(const std::string& attribute_name) const;
  HOIST_RECOGNITION_EXPORT const MaterialSpec*
  findMaterial(const std::string& material_name) const;
};

inline std::size_t
AttributeSpec::outputs() const
{
  if (type == AttributeType::categorical)
    return values.size();
  return components.empty() ? 1 : components.size();
}

/** \brief Reads and checks an ontology.
 *  \throws LoadError with file, line, path in the file and reason, e.g.
 *  "site.yaml:12: attributes.color.range: expected two numbers, found 'wide'" */
HOIST_RECOGNITION_EXPORT Ontology loadOntology(const std::filesystem::path& file);

/** \brief The same of a text; \a name of the file, for messages.
 *  \throws LoadError */
HOIST_RECOGNITION_EXPORT Ontology ontologyFromYaml(const std::string& text,
                                                   const std::string& name = "YAML");

} // namespace hoist
