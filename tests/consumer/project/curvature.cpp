// The principal curvatures of a torus's outer equator are 1/r and 1/(R + r).
#include <cmath>
#include <cstdio>

#include <dupin/nurbs/surface.h>

int main() {
  const dupin::Surface torus{dupin::Torus{{}, 3.0, 1.0}};
  const dupin::Curvature c = dupin::principal_curvature(torus, 0.3, 0.0, {0.3, 0.0});
  std::printf("k1 %g, k2 %g\n", c.k1, c.k2);
  return std::abs(std::abs(c.k1) - 1) < 1e-12 && std::abs(std::abs(c.k2) - 0.25) < 1e-12 ? 0 : 1;
}
