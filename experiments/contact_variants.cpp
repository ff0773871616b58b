// Which variant of the contact algorithm is the paper's? Figures 2 and 3 with interference volumes between
// polygons of 32 or 128 vertices, with the whole gradient or the one with frozen hit time, global or local
// coupling, full or self mobility in the LCP matrix; and with the exact gap.

#include "experiment.hpp"
#include "two_discs.hpp"

namespace {

using namespace stokes;

const std::vector<std::string> separations = {"0", "2", "2.1", "2.5", "3"};            // delta / h, Figure 2
const std::vector<double> published = {0.093, 0.093, 0.100, 0.1235, 0.167};            // its displacements
const std::vector<std::string> heights = {"0.75", "0.755", "0.76"};                    // Figure 3

struct Variant {
  std::string name;
  TwoDiscs parameters;
};

std::vector<Variant> variants() {
  std::vector<Variant> all;
  for (const auto& [coupling, coupling_name] : {std::pair(Coupling::global, "global"), std::pair(Coupling::local, "local")})
    for (const auto& [matrix, matrix_name] : {std::pair(LcpMatrix::full, "full"), std::pair(LcpMatrix::self, "self")}) {
      TwoDiscs parameters;
      parameters.coupling = coupling;
      parameters.lcp_matrix = matrix;
      all.push_back({concat("gap_", coupling_name, "_", matrix_name), parameters});
      parameters.contact = ContactModel::stiv;
      for (int vertices : {32, 128})
        for (const auto& [gradient, gradient_name] :
             {std::pair(StivGradient::full, "whole"), std::pair(StivGradient::frozen, "frozen")}) {
          parameters.stiv_vertices = vertices;
          parameters.stiv_gradient = gradient;
          all.push_back({concat("stiv", vertices, "_", gradient_name, "_", coupling_name, "_", matrix_name), parameters});
        }
    }
  return all;
}

double end_height(const TwoDiscRun& run) { return run.failure.empty() ? run.left.back().imag() : std::nan(""); }

void run_case(const std::string& name, const Results& results) {
  for (const Variant& variant : variants()) {
    if (variant.name != name) continue;
    Quantities row;
    double sum = 0.0;
    long completed = 0, runs = 0, largest_ncp = 0;
    const auto run = [&](const TwoDiscs& parameters) {
      const TwoDiscRun result = run_two_discs(parameters);
      ++runs, completed += result.failure.empty();
      largest_ncp = std::max(largest_ncp, result.largest_ncp_iterations);
      return end_height(result);
    };
    for (std::size_t k = 0; k < separations.size(); ++k) {
      TwoDiscs parameters = variant.parameters;
      parameters.separation_over_h = *parse_number(separations[k]);
      const double displacement = run(parameters) - parameters.first.imag();
      row.push_back({concat("displacement_", separations[k], "h"), displacement});
      if (k > 0) sum += (displacement - published[k]) * (displacement - published[k]);
    }
    row.push_back({"rms_from_published", std::sqrt(sum / static_cast<double>(separations.size() - 1))});
    for (const std::string& height : heights) {
      TwoDiscs parameters = variant.parameters;
      parameters.separation_over_h = 3.0;
      parameters.first = {-8.0, *parse_number(height)};
      parameters.time_step = 0.1;
      row.push_back({concat("end_y", height), run(parameters)});
    }
    const std::size_t n = row.size();
    row.push_back({"lowest_above_middle", row[n - 3].second > row[n - 2].second ? 1.0 : 0.0});
    row.push_back(
        {"lowest_path_crosses", row[n - 3].second > row[n - 2].second && row[n - 3].second > row[n - 1].second ? 1.0 : 0.0});
    row.push_back({"largest_ncp_iterations", static_cast<double>(largest_ncp)});
    row.push_back({"completed", static_cast<double>(completed)});
    row.push_back({"runs", static_cast<double>(runs)});
    results.write(name, row);
  }
}

// table.csv: all variants, numbered in the order of the comment lines.
void collect(const Results& results) {
  std::vector<std::string> header;
  std::vector<std::vector<double>> rows;
  Comments legend = {{"published", "displacements .093 .100 .1235 .167 at 2h 2.1h 2.5h 3h; ends .779 .771 .774"}};
  double number = 0.0;
  for (const Variant& variant : variants()) {
    ++number;
    if (!results.has(variant.name)) continue;
    const Table table = read_csv(results.path(variant.name));
    header = table.header;
    header.insert(header.begin(), "variant");
    std::vector<double> row = {number};
    for (int column = 0; column < static_cast<int>(table.header.size()); ++column) row.push_back(table.number(0, column));
    rows.push_back(row);
    legend.push_back({concat("variant ", number), variant.name});
  }
  results.write("table", header, rows, legend);
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const Variant& variant : variants()) names.push_back(variant.name);
  return names;
}

}  // namespace

int main(int argc, char** argv) { return run_experiment({"contact_variants", cases(), run_case, collect}, argc, argv); }
