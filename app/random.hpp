#pragma once
// Random numbers that are the same on every machine.

#include <cstdint>

namespace greenwater {

/// From -1 to 1, of a number the same at every call (Steele, Lea and Flood's splitmix64).
inline double random_of(std::uint64_t number) {
  number = (number + 1) * 0x9e3779b97f4a7c15U;
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9U;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebU;
  number ^= number >> 31;
  return static_cast<double>(number >> 11) * 0x1p-52 - 1;  // 53 bits: exact
}

}  // namespace greenwater
