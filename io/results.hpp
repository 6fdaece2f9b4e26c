#pragma once
// results.h5: the frames of a run. Layout, for h5py and the like:
//   /                 attributes: program, version, git, kokkos, backend, command_line, created, case (its whole text)
//   /frames/000000/   attributes: time [s], step, name; one data set per column, each with its unit as an attribute
//   /frames/000000/walls/   only where walls move: a row for each corner; position, and wall, the number of its wall
//   /frames/000000/NAME/    of a structure: position, displacement, velocity of its nodes; in NAME_elements the nodes
//                           of its elements, and stress (xx, yy, zz, xy, yz, xz)
// The file is closed between frames, so that a killed run leaves it readable, with every frame written before.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/table.hpp"
#include "core/wall_shape.hpp"

namespace greenwater {

enum class Precision { float32, float64 };

/// What the file says about where it comes from.
struct ResultsOrigin {
  std::vector<std::pair<std::string, std::string>> attributes;  ///< name, text; in the order written
  std::string case_text;
};

class Results {
 public:
  /// Creates the file with its origin and an empty /frames. Throws FileError.
  Results(const std::filesystem::path& path, const ResultsOrigin& origin, Precision precision);

  /// Appends a frame, with the walls where they are now if any are given, and other tables in groups of their names; real
  /// columns are stored in the file's precision. Throws FileError with the cause (disk full ...); what was written
  /// before stays readable.
  void write(const Table& table, const std::vector<WallShape>& walls = {}, std::vector<Table> groups = {});

  std::int64_t frames() const { return frames_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  Precision precision_;
  std::int64_t frames_ = 0;
};

/// Bytes of the table's values in a file of that precision.
double stored_bytes(const Table& table, Precision precision);

}  // namespace greenwater
