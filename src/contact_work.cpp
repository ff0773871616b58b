#include "contact_work.hpp"

#include "text.hpp"

namespace stokes {

std::string negative_work(const std::vector<Wrench>& contact, const std::vector<RigidVelocity>& with,
                          const std::vector<RigidVelocity>& without) {
  double total = 0.0, least = 0.0;
  std::size_t body = 0;
  for (std::size_t i = 0; i < contact.size(); ++i) {
    const double power = dot(contact[i].force, with[i].velocity - without[i].velocity) +
                         contact[i].torque * (with[i].omega - without[i].omega);
    total += power;
    if (power < least) least = power, body = i;
  }
  if (!(total < 0.0)) return {};
  return concat("the contact forces do negative work (power ", brief(total), "), most of it on body ", body,
                ", which moves against its own: the nodes do not resolve so small a gap; ", finer_nodes);
}

}  // namespace stokes
