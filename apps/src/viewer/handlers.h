#pragma once

#include <functional>
#include <string>

namespace hoist {

/** \brief Called when a key is pressed; \a symbol as X names it.
 *  \return true if the key was the viewer's own, so that nobody else gets it */
using KeyHandler = std::function<bool(const std::string& symbol, bool ctrl, bool alt)>;

/** \brief Called when the left button is pressed at (\a x, \a y) of the window [px],
 *  from its lower left corner.
 *  \return true if the click was the viewer's own */
using ClickHandler = std::function<bool(int x, int y, bool shift)>;

} // namespace hoist
