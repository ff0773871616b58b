#include "solved_response.hpp"

#include <algorithm>

namespace stokes {

SolvedResponse::SolvedResponse(const ContactStep& step, MobilityFunction column, ResponseFunction response,
                               ContactAnswers answers)
    : ContactResponse(step, std::move(column)), response_(std::move(response)), answers_(std::move(answers)) {}

Response SolvedResponse::motion(const Candidates& candidates, const std::vector<Wrench>& wrenches, bool) {
  Response result = step_.contact_free;
  if (std::none_of(candidates.begin(), candidates.end(), [](const Candidate& c) { return c.total() > 0.0; })) return result;
  const Response answer = response_(wrenches, expected_density(candidates));
  for (const Candidate& c : candidates) multipliers(c).push_back(c.total());
  answers_.densities.push_back(answer.density);
  add(result, 1.0, answer);
  return result;
}

std::vector<double>& SolvedResponse::multipliers(const Candidate& c) {
  std::vector<double>& result = answers_.multipliers[identity(c.constraint)];
  result.resize(answers_.densities.size());
  return result;
}

// The combination of known answers that is nearest to the present forces, changed by the columns to what they are.
ComplexVector SolvedResponse::expected_density(const Candidates& candidates) {
  const auto m = static_cast<Eigen::Index>(candidates.size()), n = static_cast<Eigen::Index>(answers_.densities.size());
  Matrix answered(m, n);
  Vector wanted(m), weight(m);
  for (Eigen::Index l = 0; l < m; ++l) {
    const Candidate& c = candidates[l];
    wanted[l] = c.total();
    weight[l] = scale(l);
    const std::vector<double>& earlier = multipliers(c);
    for (Eigen::Index j = 0; j < n; ++j) answered(l, j) = earlier[j];
  }
  const Vector part = nearest_combination(answered, wanted, weight), rest = wanted - answered * part;
  ComplexVector density = ComplexVector::Zero(step_.contact_free.density.size());
  for (Eigen::Index j = 0; j < n; ++j) density += part[j] * answers_.densities[j];
  for (Eigen::Index l = 0; l < m; ++l)
    if (candidates[l].column.density.size() > 0) density += rest[l] * candidates[l].column.density;
  return density;
}

ContactResponseFactory solved(MobilityFunction column, ResponseFunction response) {
  return [column = std::move(column), response = std::move(response)](const ContactStep& step) {
    return std::make_unique<SolvedResponse>(step, column, response);
  };
}

}  // namespace stokes
