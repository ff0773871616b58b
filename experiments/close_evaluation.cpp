// Section 3.1: the error of the paper's near-singular quadrature, upsampling and interpolation from the boundary
// limit, on targets nearer than a point spacing h outside a disc and a 3:1 ellipse.
//
// Cases disc, ellipse3: beside the error of Cauchy integrals, at 400 random targets with the density
// (cos 2 alpha + i sin alpha)/sqrt(2), against 1024 points. That density was once picked among about twenty for a
// likeness to known errors of which neither density, targets nor norm are known; nothing is compared with it now.
//
// Cases disc_spread, ellipse3_spread: how much the error depends on what a table of errors leaves unsaid, the
// density, the distances and the norm. The family was fixed, and committed, before any of its errors were seen;
// nothing was added or taken out afterwards. It holds 34 densities of largest modulus 1, none a rigid motion:
//   cos k alpha, sin k alpha in each component and e^{+-i k alpha}, k = 1..4: the smooth densities there are
//     at N = 16, where k = 4 has four points a wave;
//   exp(cos alpha), exp(sin alpha) in each component: all modes at once, decaying fast;
//   the densities of a free body in the strains E11 and E12, and beside a free disc of radius 0.5 whose centre
//     lies at distance 1, off the tip or off the flat side, pulled along either axis: what simulations meet.
// Targets stand at 61 equal steps of the parameter (a prime: all positions between nodes occur) at the
// distances 0.1h, 0.5h, 0.9h, and a sweep of nine from 0.01h to 0.9h in equal ratios. The norm that counts is
// the largest error of the sweep (error_*, order_*); the root mean square is listed beside it, and order_all_* are
// the orders over all densities, target sets and both norms.

#include <algorithm>
#include <random>

#include "cauchy.hpp"
#include "experiment.hpp"
#include "fourier.hpp"
#include "interpolation.hpp"
#include "stokes_system.hpp"

namespace {

using namespace stokes;

constexpr int reference_points = 1024, targets = 400;
const std::vector<int> resolutions = {16, 32, 64, 128, 256};

// A density where the family is resolved to round-off; coarser curves take every second, fourth, ... value.
struct Density {
  std::string name;
  ComplexVector values;
};
constexpr int density_points = 256, positions = 61, sweep_distances = 9;

ComplexVector density(int points) {
  ComplexVector eta(points);
  for (int k = 0; k < points; ++k) {
    const double alpha = 2.0 * pi * k / points;
    eta[k] = Complex(std::cos(2.0 * alpha), std::sin(alpha)) / std::sqrt(2.0);
  }
  return eta;
}

// The point of the ellipse with parameter alpha, moved outwards along the normal.
Complex beside(const Shape& shape, double alpha, double distance) {
  const Complex normal(shape.b * std::cos(alpha), shape.a * std::sin(alpha));
  return Complex(shape.a * std::cos(alpha), shape.b * std::sin(alpha)) + distance * normal / std::abs(normal);
}

// Points outside the ellipse, uniform in parameter and, up to one spacing, in distance along the normal.
std::vector<Complex> near_targets(const Shape& shape, double spacing) {
  std::mt19937_64 generator(1);
  const auto uniform = [&generator] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  std::vector<Complex> z;
  for (int i = 0; i < targets; ++i) {
    const double alpha = 2.0 * pi * uniform(), distance = spacing * uniform();
    z.push_back(beside(shape, alpha, distance));
  }
  return z;
}

ComplexVector velocity(const VelocityRows& rows, const ComplexVector& eta) {
  return rows.direct * eta + rows.conjugate * eta.conjugate();
}

void run_schemes(const std::string& name, const Shape& shape, const Results& results) {
  std::vector<std::vector<double>> rows;
  Quantities row;
  for (int n : resolutions) {
    const Curve curve = shape.curve(n);
    const std::vector<Complex> z = near_targets(shape, curve.length() / n);
    const CloseEvaluation exact(shape.curve(reference_points), Side::exterior, 1);
    const ComplexVector reference = velocity(exact.velocity_rows(z), density(reference_points));
    const ComplexVector eta = density(n);
    const ComplexVector interpolated =
        velocity(InterpolationEvaluation(curve, Side::exterior).velocity_rows(z), eta) - reference;
    const ComplexVector cauchy = velocity(CloseEvaluation(curve, Side::exterior, 3).velocity_rows(z), eta) - reference;
    const double count = std::sqrt(static_cast<double>(targets));
    rows.push_back({static_cast<double>(n), interpolated.norm() / count, interpolated.cwiseAbs().maxCoeff(),
                    cauchy.norm() / count, cauchy.cwiseAbs().maxCoeff()});
    row.push_back({concat("interpolation_rms_", n), rows.back()[1]});
    row.push_back({concat("interpolation_max_", n), rows.back()[2]});
    row.push_back({concat("cauchy_max_", n), rows.back()[4]});
  }
  results.write(name, row);
  results.write(name + "_table",
                {"points", "interpolation_rms", "interpolation_max", "cauchy_rms", "cauchy_max"}, rows);
}

// The density of a free body in the flow conj(x), the body turned by -strain_angle: in its own frame the strain
// is e^{2 i strain_angle}.
ComplexVector strained(const Shape& shape, double strain_angle) {
  ShapeCache shapes;
  const StokesSystem system({{.shape = shape, .pose = {0.0, -strain_angle}}}, density_points, shapes, {1e-12});
  return system.solve({FlowKind::extension}, {}).density;
}

// And beside a free disc of radius 0.5 that is pulled, the body being free too.
ComplexVector beside_pulled_disc(const Shape& shape, Complex centre, Complex force) {
  ShapeCache shapes;
  const Suspension bodies{{.shape = shape, .pose = {}}, {.shape = {0.5, 0.5}, .pose = {centre, 0.0}}};
  const StokesSystem system(bodies, density_points, shapes, {1e-12});
  return system.solve({}, {{}, {force, 0.0}}).density.head(density_points);
}

std::vector<Density> family(const Shape& shape) {
  std::vector<Density> densities;
  const auto add = [&](const std::string& name, const auto& function) {
    ComplexVector eta(density_points);
    for (int k = 0; k < density_points; ++k) eta[k] = function(2.0 * pi * k / density_points);
    densities.push_back({name, eta});
  };
  for (int k = 1; k <= 4; ++k) {
    for (const auto& [component, unit] : {std::pair("x", Complex(1.0)), std::pair("y", imaginary_unit)}) {
      add(concat("cos", k, component), [k, unit](double alpha) { return unit * std::cos(k * alpha); });
      add(concat("sin", k, component), [k, unit](double alpha) { return unit * std::sin(k * alpha); });
    }
    add(concat("wave+", k), [k](double alpha) { return std::polar(1.0, k * alpha); });
    add(concat("wave-", k), [k](double alpha) { return std::polar(1.0, -k * alpha); });
  }
  for (const auto& [component, unit] : {std::pair("x", Complex(1.0)), std::pair("y", imaginary_unit)}) {
    add(concat("expcos_", component), [unit](double alpha) { return unit * std::exp(std::cos(alpha)); });
    add(concat("expsin_", component), [unit](double alpha) { return unit * std::exp(std::sin(alpha)); });
  }
  densities.push_back({"strain11", strained(shape, 0.0)});
  densities.push_back({"strain12", strained(shape, 0.25 * pi)});
  const Complex off_tip(shape.a + 1.0, 0.0), off_side(0.0, shape.b + 1.0);
  for (const auto& [place, centre] : {std::pair("tip", off_tip), std::pair("side", off_side)}) {
    densities.push_back({concat(place, "_x"), beside_pulled_disc(shape, centre, 1.0)});
    densities.push_back({concat(place, "_y"), beside_pulled_disc(shape, centre, imaginary_unit)});
  }
  for (Density& d : densities) d.values /= d.values.cwiseAbs().maxCoeff();
  return densities;
}

// Distances over h, and where among the targets they stand.
struct TargetSet {
  double nearest, farthest;
  int first, count;
};
const std::vector<TargetSet> target_sets = {{0.1, 0.1, 0, positions},
                                            {0.5, 0.5, positions, positions},
                                            {0.9, 0.9, 2 * positions, positions},
                                            {0.01, 0.9, 3 * positions, sweep_distances * positions}};

std::vector<Complex> ringed_targets(const Shape& shape, double spacing) {
  std::vector<Complex> z;
  for (const TargetSet& set : target_sets)
    for (int ring = 0; ring < set.count / positions; ++ring)
      for (int i = 0; i < positions; ++i) {
        const double ratio = set.count == positions ? 0.0 : ring / (sweep_distances - 1.0);
        const double distance = set.nearest * std::pow(set.farthest / set.nearest, ratio);
        z.push_back(beside(shape, 2.0 * pi * (i + 0.5) / positions, distance * spacing));
      }
  return z;
}

// Errors of every density (row) in every target set, first the largest of each set, then the root mean squares.
Matrix family_errors(const Shape& shape, const std::vector<Density>& densities, int n) {
  const Curve curve = shape.curve(n);
  const std::vector<Complex> z = ringed_targets(shape, curve.length() / n);
  const VelocityRows rows = InterpolationEvaluation(curve, Side::exterior).velocity_rows(z);
  const VelocityRows exact = CloseEvaluation(shape.curve(density_points), Side::exterior, 2).velocity_rows(z);
  const int sets = static_cast<int>(target_sets.size()), count = static_cast<int>(densities.size());
  Matrix errors(count, 2 * sets);
  for (int d = 0; d < count; ++d) {
    const ComplexVector& eta = densities[d].values;
    ComplexVector coarse(n);
    for (int k = 0; k < n; ++k) coarse[k] = eta[k * (density_points / n)];
    const ComplexVector error = velocity(rows, coarse) - velocity(exact, eta);
    for (int s = 0; s < sets; ++s) {
      const auto part = error.segment(target_sets[s].first, target_sets[s].count);
      errors(d, s) = part.cwiseAbs().maxCoeff();
      errors(d, sets + s) = part.norm() / std::sqrt(static_cast<double>(part.size()));
    }
  }
  return errors;
}

// Largest error of the velocities taken for exact, over the family, against those from 1024 points.
double reference_error(const Shape& shape, const std::vector<Density>& densities) {
  const std::vector<Complex> z = ringed_targets(shape, shape.perimeter() / density_points);
  const VelocityRows rows = CloseEvaluation(shape.curve(density_points), Side::exterior, 2).velocity_rows(z);
  const VelocityRows fine = CloseEvaluation(shape.curve(reference_points), Side::exterior, 1).velocity_rows(z);
  double largest = 0.0;
  for (const Density& d : densities) {
    const ComplexVector error = velocity(rows, d.values) - velocity(fine, fourier_upsample(d.values, reference_points));
    largest = std::max(largest, error.cwiseAbs().maxCoeff());
  }
  return largest;
}

struct Range {
  double smallest, median, largest;
};

Range range(const Matrix& values) {
  std::vector<double> sorted(values.data(), values.data() + values.size());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  return {sorted.front(), 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]), sorted.back()};
}

void add_range(Quantities& row, const std::string& name, int n, const Range& r) {
  row.push_back({concat(name, "_smallest_", n), r.smallest});
  row.push_back({concat(name, "_median_", n), r.median});
  row.push_back({concat(name, "_largest_", n), r.largest});
}

void run_spread(const std::string& name, const Shape& shape, const Results& results) {
  const std::vector<Density> densities = family(shape);
  const int sets = static_cast<int>(target_sets.size()), sweep = sets - 1;
  Quantities row{{"reference_error", reference_error(shape, densities)}};
  std::vector<std::vector<double>> table, by_density;
  Matrix previous;
  for (int n : resolutions) {
    const Matrix errors = family_errors(shape, densities, n);
    const Vector stated = errors.col(sweep);
    const Range r = range(stated);
    add_range(row, "error", n, r);
    if (previous.size() > 0) {
      const Matrix orders = (previous.array() / errors.array()).log() / std::log(2.0);
      add_range(row, "order", n, range(orders.col(sweep)));
      add_range(row, "order_all", n, range(orders));
    }
    previous = errors;
    row.push_back({concat("spread_densities_", n), r.largest / r.smallest});
    row.push_back({concat("spread_targets_norms_", n),
                   range(errors.rowwise().maxCoeff().array() / errors.rowwise().minCoeff().array()).median});
    row.push_back({concat("spread_all_", n), errors.maxCoeff() / errors.minCoeff()});
    for (int s = 0; s < sets; ++s) {
      const Range max = range(errors.col(s)), rms = range(errors.col(sets + s));
      table.push_back({static_cast<double>(n), target_sets[s].nearest, target_sets[s].farthest, max.smallest,
                       max.median, max.largest, rms.smallest, rms.median, rms.largest});
    }
    by_density.push_back({static_cast<double>(n)});
    by_density.back().insert(by_density.back().end(), stated.begin(), stated.end());
  }
  results.write(name, row);
  results.write(name + "_table", {"points", "nearest_over_h", "farthest_over_h", "max_smallest", "max_median",
                                  "max_largest", "rms_smallest", "rms_median", "rms_largest"}, table);
  std::vector<std::string> header{"points"};
  for (const Density& d : densities) header.push_back(d.name);
  results.write(name + "_densities", header, by_density);
}

void run_case(const std::string& name, const Results& results) {
  const Shape shape = name.starts_with("disc") ? Shape{1.0, 1.0} : Shape{1.0, 1.0 / 3.0};
  if (name.ends_with("_spread"))
    run_spread(name, shape, results);
  else
    run_schemes(name, shape, results);
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"close_evaluation", {"disc", "ellipse3", "disc_spread", "ellipse3_spread"}, run_case,
                         [](const Results&) {}}, argc, argv);
}
