#pragma once
// Surfaces from STL files, binary or text.

#include <filesystem>

#include "core/triangle_mesh.hpp"
#include "io/place.hpp"

namespace greenwater {

/// The triangles in the order of the file, in its unit. Corners at the same place become one vertex: also those that
/// differ by 1e-7 of the mesh, the precision of the numbers in such files. The order of the corners says where outside
/// is; the normals in the file are not looked at. Throws CaseError that names the file with the line, or the triangle
/// and its byte, the cure, and `place` where the case names the file; FileError when
/// it cannot be read.
TriangleMesh read_stl(const std::filesystem::path& path, const Place& place);

}  // namespace greenwater
