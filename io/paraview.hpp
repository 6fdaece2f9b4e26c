#pragma once
// Frames for ParaView 5.11 and later: one .vtp, or .vtu of a solid, per frame (binary, 32-bit), and a .pvd that gives
// them their times. The .pvd is replaced after each frame, so that ParaView can follow a run.

#include <filesystem>
#include <string>
#include <vector>

#include "core/table.hpp"
#include "core/wall_shape.hpp"
#include "io/vtu.hpp"

namespace greenwater {

class Paraview {
 public:
  /// Frames of one body, or of the walls, go to `folder`/`name`/`name`_000000.vtp (.vtu) and `folder`/`name`.pvd. Throws
  /// FileError.
  Paraview(const std::filesystem::path& folder, const std::string& name);

  /// Writes the rows as points. The column `position` gives the places; vectors are padded to three components; every
  /// other column becomes point data of its name. Throws FileError; earlier frames and the .pvd stay whole.
  void write(const Table& table);

  /// Writes the walls as they are at `time` [s], as write_walls() does. For walls that move. Throws FileError.
  void write(double time, const std::vector<WallShape>& walls);

  /// Writes the elements where their nodes are, as vtu_text() does. Throws FileError.
  void write(const SolidMesh& mesh, const SolidFrame& frame);

 private:
  void add(double time, const char* format, const std::string& text);

  std::filesystem::path folder_;
  std::string name_;
  std::string entries_;  // of the .pvd so far
  std::int64_t frames_ = 0;
};

/// Walls that stand, in one .vtp: shapes of two corners as lines, those of more as polygons, in their order. Throws
/// FileError.
void write_walls(const std::filesystem::path& path, const std::vector<WallShape>& walls);

/// Bytes of one .vtp of this table.
double vtp_bytes(const Table& table);

}  // namespace greenwater
