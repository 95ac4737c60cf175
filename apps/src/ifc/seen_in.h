#pragma once

#include <hoist/data/ifc/ifc_observe.h>

#include <string>
#include <vector>

namespace hoist {

/** \brief The things in a file of results or of annotations, in the world.
 *
 * A thing's key is the scene and its number, or in a sequence of annotations the
 * sequence and its label. What an annotation calls removed is missing.
 * \param camera_frame take the camera's frame for the world's where no pose is known
 * \throws LoadError, or FileError where no pose is known */
std::vector<IfcObservation> seenIn(const std::string& file, bool camera_frame);

} // namespace hoist
