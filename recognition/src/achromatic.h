#pragma once

namespace hoist {

/** \brief The chroma below which a colour is white, grey or black.
 *
 * 12, and up to 17 around blue: light in the shade is bluer than the lamp, and people
 * see bluish greys as grey (Winkler, Spillmann, Werner and Webster 2015). Shade takes
 * chroma away together with lightness, so dark colours need less, down to 40 %;
 * but below L* 30 the noise of a camera alone gives chroma, up to 20.
 *
 * \param lightness L*
 * \param hue [degrees]
 */
double leastChroma(double lightness, double hue);

} // namespace hoist
