#include "fluid_memory.hpp"

#include <algorithm>
#include <cmath>

#include "discrete_shape.hpp"

namespace stokes {

namespace {

// A quadratic polynomial: on Taylor-Green flow it saves twice as many iterations as starting from the latest density.
constexpr std::size_t extrapolation_points = 3;

}  // namespace

ComplexVector Density::on(const std::vector<Discretisation>& other_nodes) const {
  return move_densities(value, nodes, other_nodes);
}

void Density::save(StateWriter& writer) const {
  writer.line("density", path, nodes.size());
  for (const Discretisation& d : nodes) {
    std::vector<double> clusters;
    for (const NodeCluster& c : d.clusters)
      clusters.insert(clusters.end(), {c.alpha, c.width, static_cast<double>(c.points)});
    writer.line("points", d.points, d.upsampling);
    writer.line("clusters", clusters);
  }
  writer.line("values", value);
}

Density Density::restored(StateReader& reader) {
  Density density;
  reader.begin("density");
  density.path = reader.number();
  density.nodes.resize(reader.integer<std::size_t>());
  for (Discretisation& d : density.nodes) {
    reader.begin("points");
    d.points = reader.integer<int>();
    d.upsampling = reader.integer<int>();
    const std::vector<double> clusters = reader.numbers("clusters");
    for (std::size_t k = 0; k + 2 < clusters.size(); k += 3)
      d.clusters.push_back({clusters[k], clusters[k + 1], static_cast<int>(clusters[k + 2])});
  }
  density.value = reader.complex_numbers("values");
  return density;
}

void DensityHistory::append(Density density) {
  densities_.push_back(std::move(density));
  if (densities_.size() > extrapolation_points) densities_.erase(densities_.begin());
}

ComplexVector DensityHistory::extrapolated(double path, const std::vector<Discretisation>& nodes) const {
  std::vector<const Density*> known;  // of several with one path the newest
  for (auto d = densities_.rbegin(); d != densities_.rend(); ++d) {
    const auto close = [&d](const auto* k) { return std::abs(k->path - d->path) <= 1e-9 * std::abs(d->path); };
    if (std::none_of(known.begin(), known.end(), close)) known.push_back(&*d);
  }
  int count = 0;
  for (const Discretisation& d : nodes) count += d.size();
  ComplexVector guess = ComplexVector::Zero(count);
  for (const auto* d : known) {
    double weight = 1.0;
    for (const auto* other : known)
      if (other != d) weight *= (path - other->path) / (d->path - other->path);
    guess += weight * d->on(nodes);
  }
  return guess;
}

void DensityHistory::save(StateWriter& writer) const {
  writer.line("history", densities_.size());
  for (const Density& density : densities_) density.save(writer);
}

DensityHistory DensityHistory::restored(StateReader& reader) {
  DensityHistory history;
  reader.begin("history");
  history.densities_.resize(reader.integer<std::size_t>());
  for (Density& density : history.densities_) density = Density::restored(reader);
  return history;
}

void FluidMemory::save(StateWriter& writer) const {
  writer.line("path", path);
  background.save(writer);
  total.save(writer);
  std::vector<double> numbers;
  for (const Resolution& r : resolution) numbers.insert(numbers.end(), {static_cast<double>(r.points), r.factor});
  writer.line("resolution", numbers);
}

FluidMemory FluidMemory::restored(StateReader& reader) {
  FluidMemory memory;
  reader.begin("path");
  memory.path = reader.number();
  memory.background = DensityHistory::restored(reader);
  memory.total = Density::restored(reader);
  const std::vector<double> numbers = reader.numbers("resolution");
  for (std::size_t k = 0; k + 1 < numbers.size(); k += 2)
    memory.resolution.push_back({static_cast<int>(numbers[k]), numbers[k + 1]});
  return memory;
}

}  // namespace stokes
