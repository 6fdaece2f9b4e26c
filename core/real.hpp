#pragma once
// The one switch of precision. Positions and sums stay double: the particle distance is a thousandth of the tank.

namespace greenwater {

#ifdef GREENWATER_SINGLE
using real = float;
#else
using real = double;
#endif
using coord = double;  // positions: differences are taken here, then narrowed to real
using accum = double;  // sums over particles

}  // namespace greenwater
