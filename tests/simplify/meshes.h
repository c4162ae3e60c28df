// Meshes that the tests make themselves.
#ifndef DUPIN_TESTS_SIMPLIFY_MESHES_H
#define DUPIN_TESTS_SIMPLIFY_MESHES_H

#include "../../nurbs/polygon_mesh.h"

namespace dupin::test {

/// A sphere of the given radius, closed, of 4 · 2 · rings² … triangles, outwards; with exact normals.
PolygonMesh ball(int rings, double radius = 1, const Vec3& center = {});
/// A bumpy open patch of 2 n² triangles.
PolygonMesh terrain(int n);
/// A cube of twelve triangles.
PolygonMesh box();
/// Triangles that share nothing, at random.
PolygonMesh soup(int triangles, unsigned seed);
/// Both in one mesh.
PolygonMesh joined(const PolygonMesh& a, const PolygonMesh& b);

}  // namespace dupin::test

#endif
