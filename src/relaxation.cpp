#include "relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "neighbours.hpp"

namespace stokes {

namespace {

constexpr double margin_of_size = 1e-3;  // wanted beyond the clearance, so that a minimum that is nearly reached is enough
constexpr int most_steps = 20000, most_kicks = 4;

// A displacement, a velocity or a force of a body; the angular part in units of length.
struct Coordinates {
  Complex centre{0.0, 0.0};
  double angle = 0.0;
};

class Relaxation {
 public:
  Relaxation(std::vector<Body>& bodies, const Region& region, const Clearance& clearance)
      : bodies_(bodies), region_(region), clearance_(clearance), velocity_(bodies.size()), force_(bodies.size()) {
    smallest_ = std::numeric_limits<double>::infinity();
    for (const Body& body : bodies) {
      smallest_ = std::min(smallest_, body.shape.inradius());
      radius_.push_back(body.shape.circumradius());
    }
    margin_ = margin_of_size * smallest_;
  }

  // True once every gap exceeds its clearance. The parameters of the dynamics are those of the paper.
  bool minimise() {
    double dt = 0.1, mixing = 0.1;
    int downhill = 0;
    std::fill(velocity_.begin(), velocity_.end(), Coordinates{});
    for (int step = 0; step < most_steps; ++step) {
      find_forces();
      if (shortfall_ < 0.0) return true;
      if (power() > 0.0) {
        if (++downhill > 5) dt = std::min(1.1 * dt, 0.4), mixing *= 0.99;
      } else {
        downhill = 0, dt *= 0.5, mixing = 0.1;
        std::fill(velocity_.begin(), velocity_.end(), Coordinates{});
      }
      advance_bodies(dt, mixing);
    }
    return false;
  }

  void kick(UniformRandom& random) {
    const double size = 0.2 * smallest_;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const double u1 = random(), u2 = random(), u3 = random();
      move(i, {size * Complex(u1 - 0.5, u2 - 0.5), size * (u3 - 0.5)});
    }
  }

 private:
  void move(std::size_t i, const Coordinates& way) {
    bodies_[i].pose.centre += way.centre;
    bodies_[i].pose.angle += way.angle / radius_[i];
  }

  void find_forces() {
    update_pairs();
    std::fill(force_.begin(), force_.end(), Coordinates{});
    shortfall_ = -std::numeric_limits<double>::infinity();
    for (const auto& [i, j] : pairs_) {
      const Gap g = gap(bodies_[i], bodies_[j]);
      const double lacking = found(clearance_.bodies, g.value);
      if (lacking <= 0.0) continue;
      const GapGradient slope = gradient(g, bodies_[i].pose, bodies_[j].pose);
      force_[i].centre += lacking * slope.centre_a, force_[i].angle += lacking * slope.angle_a / radius_[i];
      force_[j].centre += lacking * slope.centre_b, force_[j].angle += lacking * slope.angle_b / radius_[j];
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      for (const Gap& g : region_.wall_gaps(bodies_[i].shape, bodies_[i].pose)) {
        const double lacking = found(clearance_.walls, g.value);
        if (lacking <= 0.0) continue;
        force_[i].centre -= lacking * g.normal;
        force_[i].angle -= lacking * cross(g.point_a - bodies_[i].pose.centre, g.normal) / radius_[i];
      }
  }

  // The amount by which a gap is below the wanted one; the largest is stored.
  double found(double clearance, double value) {
    shortfall_ = std::max(shortfall_, clearance - value);
    return clearance + margin_ - value;
  }

  // Pairs that can come close before a body has moved by half the reach beyond the wanted gap.
  void update_pairs() {
    const double reach = 0.5 * smallest_;
    bool valid = listed_.size() == bodies_.size();
    for (std::size_t i = 0; valid && i < bodies_.size(); ++i)
      valid = std::abs(bodies_[i].pose.centre - listed_[i]) < 0.5 * reach;
    if (valid) return;
    listed_.clear();
    for (const Body& body : bodies_) listed_.push_back(body.pose.centre);
    pairs_ = neighbour_pairs(listed_, listed_, radius_, clearance_.bodies + margin_ + reach);
  }

  double power() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      sum += dot(force_[i].centre, velocity_[i].centre) + force_[i].angle * velocity_[i].angle;
    return sum;
  }

  static double norm(const std::vector<Coordinates>& all) {
    double sum = 0.0;
    for (const Coordinates& c : all) sum += std::norm(c.centre) + c.angle * c.angle;
    return std::sqrt(sum);
  }

  // Velocities turn towards the forces. No body moves by more than a tenth of the smallest semi-axis.
  void advance_bodies(double dt, double mixing) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      velocity_[i].centre += dt * force_[i].centre;
      velocity_[i].angle += dt * force_[i].angle;
    }
    const double forces = norm(force_), turn = forces > 0.0 ? mixing * norm(velocity_) / forces : 0.0;
    const double farthest = 0.1 * smallest_;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Coordinates& v = velocity_[i];
      v.centre = (1.0 - mixing) * v.centre + turn * force_[i].centre;
      v.angle = (1.0 - mixing) * v.angle + turn * force_[i].angle;
      const double way = dt * std::max(std::abs(v.centre), std::abs(v.angle));
      const double part = way > farthest ? farthest / way : 1.0;
      move(i, {part * dt * v.centre, part * dt * v.angle});
    }
  }

  std::vector<Body>& bodies_;
  const Region& region_;
  const Clearance& clearance_;
  std::vector<double> radius_;
  double smallest_, margin_;
  double shortfall_ = 0.0;  // by which the worst gap is below its clearance; negative if none is
  std::vector<Coordinates> velocity_, force_;
  std::vector<std::pair<int, int>> pairs_;
  std::vector<Complex> listed_;  // centres for which the pairs were found
};

}  // namespace

bool relax(std::vector<Body>& bodies, const Region& region, const Clearance& clearance, UniformRandom& random) {
  Relaxation relaxation(bodies, region, clearance);
  for (int kicks = 0; !relaxation.minimise(); ++kicks) {
    if (kicks == most_kicks) return false;
    relaxation.kick(random);
  }
  return true;
}

}  // namespace stokes
