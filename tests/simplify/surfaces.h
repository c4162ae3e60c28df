// Points of surfaces that the tests of domains make themselves.
#ifndef DUPIN_TESTS_SIMPLIFY_SURFACES_H
#define DUPIN_TESTS_SIMPLIFY_SURFACES_H

#include "../../simplify/surface_points.h"

namespace dupin::test {

/// About `count` points of an octahedron with corners at ±1, at random; `faces` says which of its sides each
/// is of. Without normals.
SurfacePoints octahedron(int count, unsigned seed = 1);
/// The same on a lattice that has points on edges and corners too (of several sides: merged).
SurfacePoints octahedron_lattice(int count);
/// A cube of half-size 1.
SurfacePoints cube(int count, unsigned seed = 1);
SurfacePoints cube_lattice(int count);
/// A closed sphere of radius 1 as a mesh with normals, vertices shared.
SurfacePoints sphere_mesh(int rings);
/// The vertices and triangles of an OBJ file's polygons; empty where there is none.
SurfacePoints read_obj(const std::string& path);

}  // namespace dupin::test

#endif
