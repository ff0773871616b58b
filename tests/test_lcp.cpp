// The oracle for small problems is exact: integer data, enumeration of all 2^m complementary bases with
// fraction-free elimination (Bareiss 1968) in 64-bit integers, scaling by powers of two.
#include "lcp.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

using namespace stokes;

namespace {

constexpr int largest_m = 6;
constexpr std::array methods{LcpMethod::minimum_map_newton, LcpMethod::fischer_newton,
                             LcpMethod::projected_gauss_seidel, LcpMethod::lemke};

struct Random {
  std::mt19937_64 engine;
  explicit Random(std::uint64_t seed) : engine(seed) {}
  double unit() { return static_cast<double>(engine() >> 11) * 0x1p-53; }
  int integer(int low, int high) { return low + static_cast<int>(engine() % std::uint64_t(high - low + 1)); }
};

using Table = std::vector<std::vector<std::int64_t>>;

struct IntegerProblem {
  Table B;
  std::vector<std::int64_t> b;
  bool unique_z = false;
  int size() const { return static_cast<int>(b.size()); }
};

// Solves A x = r exactly as x = numerators / determinant (Gauss-Jordan without fractions).
struct Cramer {
  std::int64_t determinant = 1;
  std::vector<std::int64_t> numerators;
};

Cramer solve_exactly(Table a) {
  const std::size_t n = a.size();
  Cramer result;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    while (pivot < n && a[pivot][k] == 0) ++pivot;
    if (pivot == n) return {0, {}};
    if (pivot != k) {
      std::swap(a[pivot], a[k]);
      for (auto& entry : a[k]) entry = -entry;
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const std::int64_t factor = a[i][k];
      for (std::size_t j = 0; j <= n; ++j)
        a[i][j] = (a[k][k] * a[i][j] - factor * a[k][j]) / result.determinant;
    }
    result.determinant = a[k][k];
  }
  for (const auto& row : a) result.numerators.push_back(row[n]);
  return result;
}

struct Oracle {
  bool solvable = false, all_minors_positive = true;
  std::vector<double> z, w;
};

Oracle enumerate_bases(const IntegerProblem& problem) {
  const int m = problem.size();
  Oracle oracle;
  for (unsigned mask = 0; mask < 1u << m; ++mask) {
    std::vector<int> basic;
    for (int i = 0; i < m; ++i)
      if (mask >> i & 1u) basic.push_back(i);
    Table system;
    for (const int i : basic) {
      system.emplace_back();
      for (const int j : basic) system.back().push_back(problem.B[i][j]);
      system.back().push_back(-problem.b[i]);
    }
    const Cramer cramer = solve_exactly(system);
    oracle.all_minors_positive = oracle.all_minors_positive && cramer.determinant > 0;
    if (cramer.determinant == 0 || oracle.solvable) continue;
    const std::int64_t sign = cramer.determinant > 0 ? 1 : -1;
    std::vector<std::int64_t> z(m, 0), w;
    for (std::size_t k = 0; k < basic.size(); ++k) z[basic[k]] = sign * cramer.numerators[k];
    for (int i = 0; i < m; ++i) {
      w.push_back(problem.b[i] * sign * cramer.determinant);
      for (int j = 0; j < m; ++j) w.back() += problem.B[i][j] * z[j];
    }
    const auto negative = [](std::int64_t value) { return value < 0; };
    if (std::any_of(z.begin(), z.end(), negative) || std::any_of(w.begin(), w.end(), negative)) continue;
    oracle.solvable = true;
    const double divisor = static_cast<double>(sign * cramer.determinant);
    for (int i = 0; i < m; ++i) {
      oracle.z.push_back(static_cast<double>(z[i]) / divisor);
      oracle.w.push_back(static_cast<double>(w[i]) / divisor);
    }
  }
  return oracle;
}

enum Kind { definite, low_rank, duplicated, immobile, nonsymmetric, p_matrix, jam_prone, degenerate, kinds };

// B = J J^T as for contacts with Jacobian J, changed according to the kind.
IntegerProblem random_problem(Random& random, Kind kind) {
  const int m = random.integer(1, largest_m);
  const int rank = kind == jam_prone ? random.integer(1, 2) : kind == low_rank ? random.integer(1, m) : m;
  Table J(m, std::vector<std::int64_t>(rank));
  for (auto& row : J)
    for (auto& entry : row) entry = random.integer(-2, 2);
  if (kind == duplicated || kind == degenerate)
    for (int copies = random.integer(1, m); copies > 0; --copies) {
      const auto row = J[random.integer(0, m - 1)];
      J[random.integer(0, m - 1)] = row;
    }
  if (kind == immobile) J[random.integer(0, m - 1)].assign(rank, 0);

  IntegerProblem problem;
  problem.B.assign(m, std::vector<std::int64_t>(m));
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j)
      for (int k = 0; k < rank; ++k) problem.B[i][j] += J[i][k] * J[j][k];
  for (int i = 0; i < m; ++i) {
    if (kind == definite || kind == nonsymmetric) problem.B[i][i] += 1;
    for (int j = 0; j < i && kind == nonsymmetric; ++j) {
      const int skew = random.integer(-3, 3);
      problem.B[i][j] += skew;
      problem.B[j][i] -= skew;
    }
  }
  if (kind == p_matrix) {  // a triangular matrix with its rows and columns permuted alike
    std::vector<int> order;
    for (int i = 0; i < m; ++i) order.push_back(i);
    for (int i = m - 1; i > 0; --i) std::swap(order[i], order[random.integer(0, i)]);
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j)
        problem.B[order[i]][order[j]] = i == j ? random.integer(1, 3) : j > i ? random.integer(-6, 6) : 0;
  }
  for (int i = 0; i < m; ++i)
    problem.b.push_back(kind == degenerate ? 0 : random.integer(-5, kind == jam_prone ? 0 : 5));
  for (int j = 0; j < m && kind == degenerate; ++j) {  // b = w - B z with many j where z_j = w_j = 0
    const int choice = random.integer(-3, 3);
    problem.b[j] += std::max(0, -choice) / 2;
    for (int i = 0; i < m; ++i) problem.b[i] -= problem.B[i][j] * (std::max(0, choice) / 2);
  }
  problem.unique_z = kind == definite || kind == nonsymmetric || kind == p_matrix;
  return problem;
}

// Row and column i are multiplied by 2^exponent[i], B by 2^of_B and b by 2^of_b.
struct Scaling {
  std::vector<int> exponent;
  int of_B = 0, of_b = 0;
};

Scaling random_scaling(Random& random, int m) {
  Scaling scaling{std::vector<int>(m, 0), 0, 0};
  if (random.integer(0, 1) == 0) return scaling;
  for (int& exponent : scaling.exponent) exponent = random.integer(-12, 12);
  scaling.of_B = random.integer(-40, 10);
  scaling.of_b = random.integer(-40, 10);
  return scaling;
}

// What every answer obeys, whatever the problem.
bool is_sound(const LcpResult& result, int m) {
  return result.z.size() == m && !std::isnan(result.residual) && result.message.empty() == result.solved &&
         std::all_of(result.z.begin(), result.z.end(), [](double z) { return z >= 0.0 && std::isfinite(z); });
}

bool says_infeasible(const LcpResult& result) {
  return !result.solved && result.message.find("infeasible") != std::string::npos;
}

// Empty, or what is wrong with the solver's answer.
std::string complaint(const IntegerProblem& problem, const Oracle& oracle, const Scaling& scaling,
                      LcpMethod method) {
  const int m = problem.size();
  const std::vector<int>& exponent = scaling.exponent;
  Matrix B(m, m);
  Vector b(m);
  for (int i = 0; i < m; ++i) {
    b(i) = std::ldexp(problem.b[i], exponent[i] + scaling.of_b);
    for (int j = 0; j < m; ++j)
      B(i, j) = std::ldexp(problem.B[i][j], exponent[i] + exponent[j] + scaling.of_B);
  }
  const LcpResult result = solve_lcp(B, b, method);
  if (!is_sound(result, m)) return "not finite, or z < 0, or message and solved disagree";
  if (result.solved != oracle.solvable) return "solved is wrong: " + result.message;
  if (!result.solved) return says_infeasible(result) ? "" : result.message;
  if (!(lcp_residual(B, b, result.z) <= lcp_tolerance)) return "solved, but the residual is too large";
  double scale = 1.0;
  for (const double value : oracle.z) scale = std::max(scale, value);
  for (int i = 0; i < m; ++i) {
    // Integers of size 1 to 100 and m <= 6: conditioning costs at most a few digits.
    const double z = std::ldexp(result.z(i), exponent[i] + scaling.of_B - scaling.of_b);
    if (problem.unique_z && std::abs(z - oracle.z[i]) > 1e-11 * scale) return "z is wrong";
    long double w = b(i);
    for (int j = 0; j < m; ++j) w += static_cast<long double>(B(i, j)) * result.z(j);
    w = std::ldexp(w, -exponent[i] - scaling.of_b);
    if (std::abs(static_cast<double>(w) - oracle.w[i]) > 1e-11 * scale) return "w is wrong";
  }
  return "";
}

// B = J J^T for m contacts between random pairs of `bodies` bodies in the plane, entries of J about 1.
Matrix contact_matrix(Random& random, int m, int bodies) {
  Matrix J = Matrix::Zero(m, 3 * bodies);
  for (int l = 0; l < m; ++l) {
    const int first = random.integer(0, bodies - 2);
    const int second = random.integer(first + 1, bodies - 1);
    const double angle = 2.0 * pi * random.unit();
    J.block(l, 3 * first, 1, 3) << std::cos(angle), std::sin(angle), random.unit() - 0.5;
    J.block(l, 3 * second, 1, 3) << -std::cos(angle), -std::sin(angle), random.unit() - 0.5;
  }
  Matrix B = Matrix::Zero(m, m);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j)
      for (int k = 0; k < 3 * bodies; ++k) B(i, j) += J(i, k) * J(j, k);
  return B;
}

Vector random_vector(Random& random, int m) {
  return Vector::NullaryExpr(m, [&random] { return random.unit() - 0.5; });
}

// Solves a random problem by each of the methods and tells whether it has a solution.
bool compare_with_enumeration(Random& random, Kind kind, const std::vector<LcpMethod>& chosen) {
  const IntegerProblem problem = random_problem(random, kind);
  const Scaling scaling = random_scaling(random, problem.size());
  const Oracle oracle = enumerate_bases(problem);
  if (kind == p_matrix) REQUIRE(oracle.all_minors_positive);
  for (const LcpMethod method : chosen) {
    const std::string wrong = complaint(problem, oracle, scaling, method);
    CHECK_MESSAGE(wrong.empty(), "kind " << kind << ", " << to_string(method) << ": " << wrong);
  }
  return oracle.solvable;
}

}  // namespace

TEST_CASE("10 000 small regular and degenerate LCPs agree with exact enumeration of the bases") {
  Random random(20240501);
  std::array<std::array<int, 2>, kinds> count{};  // unsolvable and solvable problems
  for (int trial = 0; trial < 10000; ++trial) {
    const Kind kind = static_cast<Kind>(trial % kinds);
    ++count[kind][compare_with_enumeration(random, kind, {LcpMethod::automatic, LcpMethod::lemke})];
  }
  for (const Kind kind : {definite, nonsymmetric, p_matrix, degenerate}) CHECK(count[kind][0] == 0);
  for (const Kind kind : {low_rank, immobile, jam_prone})  // else the test would not see both outcomes
    CHECK(std::min(count[kind][0], count[kind][1]) > 100);
}

TEST_CASE("each method alone solves positive definite LCPs, symmetric or not") {
  Random random(7);
  for (int trial = 0; trial < 1500; ++trial)
    for (const Kind kind : {definite, nonsymmetric})
      compare_with_enumeration(random, kind, {methods.begin(), methods.end()});
}

TEST_CASE("each method alone copes with a contact that is listed twice") {
  for (const LcpMethod method : methods)
    CHECK(solve_lcp(Matrix::Ones(2, 2), Vector::Constant(2, -1.0), method).solved);
}

TEST_CASE("Lemke's method ends where it would cycle without the lexicographic rule") {
  Matrix B(4, 4);
  B << 0, 2, 0, -1, -2, 0, 1, -2, 0, -1, 0, 2, 1, 2, -2, 0;
  Vector b(4);
  b << 0, -1, -1, -1;  // infeasible, since (0, 2, 2, 1) B <= 0 and (0, 2, 2, 1) b < 0
  CHECK(says_infeasible(solve_lcp(B, b, LcpMethod::lemke)));
}

TEST_CASE("no answer is a lie: what is solved has a small residual, whatever the matrix") {
  Random random(11);
  int solved = 0, left_on_ray = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const int m = random.integer(1, largest_m);
    const Matrix B = Matrix::NullaryExpr(m, m, [&random] { return double(random.integer(-3, 3)); });
    const Vector b = Vector::NullaryExpr(m, [&random] { return double(random.integer(-3, 2)); });
    for (const LcpMethod method : {LcpMethod::automatic, methods[trial % methods.size()]}) {
      const LcpResult result = solve_lcp(B, b, method);
      REQUIRE(is_sound(result, m));
      if (result.solved) CHECK(lcp_residual(B, b, result.z) <= lcp_tolerance);
      solved += result.solved;
      left_on_ray += result.message.find("on a ray") != std::string::npos;
    }
  }
  CHECK(solved > 1000);
  CHECK(left_on_ray > 100);
}

TEST_CASE("each method solves 200 contacts with independent constraints to a residual of 1e-13") {
  Random random(200);
  const Matrix B = contact_matrix(random, 200, 100) + 0.1 * Matrix::Identity(200, 200);
  const Vector b = random_vector(random, 200);
  for (const LcpMethod method : methods) {
    const LcpResult result = solve_lcp(B * 1e-8, b * 1e-9, method);
    CHECK_MESSAGE(result.residual <= 1e-13, to_string(method) << ": " << result.message);
    CHECK((result.solved && result.method == method));
  }
}

TEST_CASE("redundant contacts, exact or up to rounding, leave the residual at 1e-13") {
  int by_newton = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const int m = 40;
    Matrix B = contact_matrix(random, m, 20);  // copied rows and columns: B is singular
    for (int copies = 0; copies < 10; ++copies) {
      const int from = random.integer(0, m - 1), to = random.integer(0, m - 1);
      B.row(to) = Vector(B.row(from));
      B.col(to) = Vector(B.col(from));
    }
    const auto rounded = [&random](double entry) { return entry * (1.0 + 1e-15 * (random.unit() - 0.5)); };
    if (seed % 2 == 0) B = B.unaryExpr(rounded).eval();
    Vector b = Vector::Zero(m);  // b = w - B z with z, w >= 0 and often both zero
    for (int j = 0; j < m; ++j) {
      const double choice = 3.0 * random.unit();
      if (choice < 1.0) b(j) += choice;
      for (int i = 0; i < m && choice > 2.0; ++i) b(i) -= B(i, j) * (choice - 2.0);
    }
    const LcpResult result = solve_lcp(B, b);
    CHECK_MESSAGE(result.residual <= 1e-13, "seed " << seed << ": " << result.message);
    by_newton += result.method == LcpMethod::minimum_map_newton;
  }
  CHECK(by_newton > 45);  // 59, but 16 if the minimum map does not regularise singular active sets
}

TEST_CASE("the answer scales with B and b, exactly so for powers of two") {
  Random random(3);
  const Matrix B = contact_matrix(random, 12, 8) + 0.1 * Matrix::Identity(12, 12);
  const Vector b = random_vector(random, 12);
  for (const LcpMethod method : methods) {
    const Vector z = solve_lcp(B, b, method).z;
    CHECK(solve_lcp(B, b, method).z == z);
    CHECK(solve_lcp(B * 0x1p-28, b * 0x1p-30, method).z == Vector(z * 0x1p-2));
    const LcpResult small = solve_lcp(B * 1e-8, b * 1e-9, method);
    REQUIRE(small.solved);
    for (int i = 0; i < 12; ++i) CHECK(std::abs(small.z(i) - 0.1 * z(i)) <= 1e-12 * std::abs(z(i)));
  }
}

TEST_CASE("b >= 0 is answered by z = 0 without iterations, whatever B") {
  const LcpResult result = solve_lcp(-Matrix::Identity(3, 3), Vector::Unit(3, 1));
  CHECK((result.solved && result.z == Vector::Zero(3)));
  CHECK(result.iterations == 0);
  CHECK(solve_lcp(Matrix(0, 0), Vector(0)).solved);
}

TEST_CASE("a body squeezed between two walls and an immobile contact are reported as jammed") {
  Matrix squeezed(2, 2);
  squeezed << 1.0, -1.0, -1.0, 1.0;
  const Vector closed = Vector::Constant(2, -1e-3);
  CHECK(says_infeasible(solve_lcp(squeezed, closed)));
  CHECK(solve_lcp(squeezed, Vector(closed + 2e-3 * Vector::Unit(2, 1))).solved);  // one gap has room

  const Matrix immobile = Vector::Unit(3, 0).asDiagonal();
  const LcpResult fixed = solve_lcp(immobile, Vector::Constant(3, -1e-9));
  CHECK(says_infeasible(fixed));
  CHECK(fixed.message.find("row 1") != std::string::npos);
}

TEST_CASE("non-finite entries, wrong shapes and extreme scales give a message, not an exception") {
  const double nan = std::nan("");
  const Matrix one = Matrix::Identity(2, 2);
  const Vector minus = Vector::Constant(2, -1.0);
  for (const LcpMethod method : methods) {
    CHECK(is_sound(solve_lcp(one, Vector::Constant(2, nan), method), 2));
    CHECK_FALSE(solve_lcp(one * nan, minus, method).solved);
    CHECK_FALSE(solve_lcp(one / 0.0, Vector::Zero(2), method).solved);
    CHECK_FALSE(solve_lcp(Matrix::Identity(2, 3), minus, method).solved);
    for (const double size : {1e-300, 1e-200, 1e200, 1e300}) {
      CHECK(is_sound(solve_lcp(one * size, minus / size, method), 2));
      Matrix mixed(2, 2);
      mixed << 1.0, size, 0.0, 1.0 / size;
      CHECK(is_sound(solve_lcp(mixed, minus, method), 2));
    }
  }
}

TEST_CASE("the residual is measured against the worst violation and not hidden by cancellation") {
  Matrix B = Matrix::Identity(2, 2);
  Vector b(2), z(2);
  b << -1e-9, 1e-3;  // a large gap elsewhere must not make the error of 1e-12 look small
  z << 1e-9 - 1e-12, 0.0;
  CHECK(std::abs(lcp_residual(B, b, z) - 1e-3) < 1e-9);
  B << 1.0, -1.0, 1.0, -1.0;
  b << -1.0, -1.0;
  z << 1e16 + 2.0, 1e16;  // w = 1, which plain summation rounds to 0
  CHECK(lcp_residual(B, b, z) == 1.0);
}
