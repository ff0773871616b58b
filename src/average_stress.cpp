#include "average_stress.hpp"

namespace stokes {

std::vector<Complex> node_forces(const StokesSystem& system, int boundary, const ComplexVector& density,
                                 const BackgroundFlow& background, const std::vector<Wrench>& wrenches) {
  const PlacedShape& b = system.boundaries()[boundary];
  std::vector<Complex> nodes(b.size());
  for (int k = 0; k < b.size(); ++k) nodes[k] = b.node(k);
  const std::vector<PointFlow> flow = system.flow(nodes, density, background, wrenches);
  std::vector<Complex> forces(b.size());
  for (int k = 0; k < b.size(); ++k) forces[k] = traction(stress(flow[k]), b.axis * b.shape->weighted_normal(k));
  return forces;
}

Stress average_stress(const StokesSystem& system, const ComplexVector& density, const BackgroundFlow& background,
                      const std::vector<Wrench>& wrenches) {
  const std::vector<PlacedShape>& boundaries = system.boundaries();
  if (boundaries.empty() || boundaries.back().shape->kind != BoundaryKind::container)
    throw InputError("the average stress is that of a suspension in a container; there is none");
  const Complex centre = boundaries.back().pose.centre;
  Stress sum{0.0, 0.0, 0.0};
  double area = 0.0;
  for (std::size_t j = 0; j < boundaries.size(); ++j) {
    const PlacedShape& b = boundaries[j];
    if (b.shape->kind == BoundaryKind::free) continue;
    area += (b.shape->kind == BoundaryKind::container ? 1.0 : -1.0) * b.shape->curve.area();
    const std::vector<Complex> forces = node_forces(system, static_cast<int>(j), density, background, wrenches);
    for (int k = 0; k < b.size(); ++k) {
      const Complex x = b.node(k) - centre;
      sum.xx += forces[k].real() * x.real();
      sum.xy += 0.5 * (forces[k].real() * x.imag() + forces[k].imag() * x.real());
      sum.yy += forces[k].imag() * x.imag();
    }
  }
  return {sum.xx / area, sum.xy / area, sum.yy / area};
}

}  // namespace stokes
