#pragma once
// Frames for ParaView 5.11 and later: one .vtp per frame (binary, 32-bit), and a .pvd that gives them their times. The
// .pvd is replaced after each frame, so that ParaView can follow a run.

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/table.hpp"

namespace greenwater {

/// A straight wall: x, y, z of its two ends [m].
using Segment = std::array<double, 6>;

class Paraview {
 public:
  /// Frames of one body go to `folder`/`name`/`name`_000000.vtp and `folder`/`name`.pvd. Throws FileError.
  Paraview(const std::filesystem::path& folder, const std::string& name);

  /// Writes the rows as points. The column `position` gives the places; vectors are padded to three components; every
  /// other column becomes point data of its name. Throws FileError; earlier frames and the .pvd stay whole.
  void write(const Table& table);

 private:
  std::filesystem::path folder_;
  std::string name_;
  std::string entries_;  // of the .pvd so far
  std::int64_t frames_ = 0;
};

/// The walls as lines. Throws FileError.
void write_walls(const std::filesystem::path& path, const std::vector<Segment>& segments);

/// Bytes of one .vtp of this table.
double vtp_bytes(const Table& table);

}  // namespace greenwater
