#pragma once

#include <string>

namespace hoist {

/** \brief Why no window can be opened here; "" if one can. VTK would end the program
 *  with SIGABRT instead. */
std::string whyNoDisplay();

} // namespace hoist
