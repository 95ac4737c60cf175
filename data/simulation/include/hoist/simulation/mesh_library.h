#pragma once

#include <hoist/simulation/mesh_file.h>

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace hoist {
namespace simulation {

/** \brief A shape of Debian's package sweethome3d-furniture. */
struct LibraryMesh {
  std::string kind;     ///< "chair", "plant", ...
  std::string name;     ///< in the catalogue
  std::string archive;  ///< "Scopia.sh3f"
  std::string model;    ///< path of the mesh in it
  Eigen::Vector3d size; ///< depth, width, height [m], of the real thing
  Eigen::Matrix3d turn; ///< the mesh's axes to the catalogue's (x right, y up, z front)
  std::string substance; ///< of such a thing, if its materials' names say none
  bool test;             ///< kept for testing
};

/** \brief The shapes of the package that belong to a class, in the catalogue's order.
 *
 * A third of every class is for testing only; which, follows from the model's name.
 * \throws LoadError if the package is not installed or an archive is damaged
 */
const std::vector<LibraryMesh>& meshLibrary();

/** \brief Reads a shape (once a process): x forward, z up, the size of the real thing.
 *  \throws LoadError as loadMesh(), and if its archive is damaged */
std::shared_ptr<const LoadedMesh> libraryShape(const LibraryMesh& entry);

} // namespace simulation
} // namespace hoist
