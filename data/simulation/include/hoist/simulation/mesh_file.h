#pragma once

#include <hoist/simulation/material.h>
#include <hoist/simulation/mesh.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hoist {
namespace simulation {

/** \brief A shape with its materials, as a file has it. */
struct LoadedMesh {
  Mesh mesh; ///< in the file's own axes and units
  std::vector<Material> materials;
  /// What each material is made of: metal, wood, fabric, plastic; "" where its name
  /// does not say.
  std::vector<std::string> substances;
};

/** \brief What a material is made of by its name in a file, e.g. "Chrome": "metal",
 *  "wood", "fabric", "plastic"; "" if that does not say. */
std::string substanceNamed(const std::string& material);

/** \brief What most of the surface is made of; "" if the names of the materials do not
 *  say. */
std::string substanceOfMost(const LoadedMesh& shape);

/** \brief Gives the bytes of a file that a mesh names, e.g. its materials; nothing if
 *  there is none. */
using FileSource = std::function<std::optional<std::string>(const std::string&)>;

/** \brief Reads a mesh of any format that assimp knows. Pictures on it become their
 * mean colour. \throws LoadError "file:line: reason" for OBJ files whose vertices or
 * faces are wrong, "file: reason" for others */
LoadedMesh loadMesh(const std::string& file);

/** \brief The same from any source, without looking at the text of OBJ files. \param
 * name with the ending that tells its format
 */
LoadedMesh loadMesh(const std::string& name, const FileSource& source);

/** \brief Looks at every vertex and face of an OBJ text; assimp skips what is wrong.
 *  \throws LoadError naming the line */
void checkObj(const std::string& text, const std::string& name);

} // namespace simulation
} // namespace hoist
