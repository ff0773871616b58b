// pack key=value ...: random bodies for a case of simulate, written as a bodies' file.
// Exit status: 0 done; 2 bad input; 3 no places were found. Nothing is written unless it is 0.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "csv.hpp"
#include "pack_bodies.hpp"
#include "text.hpp"

namespace {

using namespace stokes;

struct Options {
  PackingRequest request;
  std::string domain;
  bool has_body_clearance = false, has_wall_clearance = false;
  std::string output = "bodies.csv";
  bool overwrite = false;
};

struct Key {
  const char *name, *standard, *help;
  std::function<void(Options&, const std::string& value)> set;
};

[[noreturn]] void refuse(const auto&... parts) { throw InputError(concat(parts...)); }

double positive(const std::string& value) {
  const auto number = parse_number(value);
  if (!number || !(*number > 0.0) || *number > 1e100) refuse("is not a number above 0; write it like 0.25 or 1e-3.");
  return *number;
}

double not_negative(const std::string& value) {
  return parse_number(value) == 0.0 ? 0.0 : positive(value);
}

long long whole(const std::string& value, long long least, long long most) {
  const auto number = parse_integer(value);
  if (!number || *number < least || *number > most) refuse("is not a whole number from ", least, " to ", most, ".");
  return *number;
}

// a b share, a b share, ...
std::vector<ShapeShare> shapes(const std::string& value) {
  std::vector<ShapeShare> result;
  for (const std::string_view group : split(value, ',')) {
    std::vector<double> numbers;
    for (const std::string_view word : split(group, ' '))
      if (!trim(word).empty()) numbers.push_back(positive(std::string(trim(word))));
    if (numbers.size() < 2 || numbers.size() > 3)
      refuse("has ", quote(trim(group)), ", which is not two semi-axes and, if there are more shapes, a share.");
    result.push_back({{numbers[0], numbers[1]}, numbers.size() == 3 ? numbers[2] : 1.0});
  }
  return result;
}

const std::vector<Key>& keys() {
  static const std::vector<Key> table = {
      {"domain", "required", "box, disc or annulus, centred at 0; the sides of a box keep bodies in, but no case has them",
       [](Options& o, const std::string& v) { o.domain = v; }},
      {"width", "required", "of a box, length",
       [](Options& o, const std::string& v) { o.request.region.width = positive(v); }},
      {"height", "width", "of a box, length",
       [](Options& o, const std::string& v) { o.request.region.height = positive(v); }},
      {"inner_radius", "required", "of an annulus, length",
       [](Options& o, const std::string& v) { o.request.region.inner_radius = positive(v); }},
      {"outer_radius", "required", "of a disc or an annulus, length",
       [](Options& o, const std::string& v) { o.request.region.outer_radius = positive(v); }},
      {"number", "", "of bodies; without it as many as come nearest to area_fraction",
       [](Options& o, const std::string& v) { o.request.number = static_cast<int>(whole(v, 1, 1000000)); }},
      {"area_fraction", "", "of the bodies in the domain; with number, too, all sizes are multiplied by what makes it",
       [](Options& o, const std::string& v) { o.request.area_fraction = positive(v); }},
      {"shapes", "1 1", "semi-axes a b, or several with their shares of the number: 1 1 0.7, 0.6 0.2 0.3",
       [](Options& o, const std::string& v) { o.request.shapes = shapes(v); }},
      {"polydispersity", "0", "standard deviation of the sizes over their mean, at most 0.5; they are uniformly distributed",
       [](Options& o, const std::string& v) { o.request.polydispersity = not_negative(v); }},
      {"body_clearance", "", "every gap of two bodies is larger; a fiftieth of the smallest semi-axis if not given",
       [](Options& o, const std::string& v) { o.request.clearance.bodies = not_negative(v), o.has_body_clearance = true; }},
      {"wall_clearance", "", "every gap to the edge of the domain is larger; a fiftieth as well",
       [](Options& o, const std::string& v) { o.request.clearance.walls = not_negative(v), o.has_wall_clearance = true; }},
      {"seed", "1", "of the random numbers; the same one makes the same bytes",
       [](Options& o, const std::string& v) { o.request.seed = static_cast<std::uint32_t>(whole(v, 0, 4294967295)); }},
      {"output", "bodies.csv", "the file that is written", [](Options& o, const std::string& v) { o.output = v; }},
      {"overwrite", "no", "yes: replace a file of that name",
       [](Options& o, const std::string& v) {
         if (v != "yes" && v != "no") refuse("can be yes or no.");
         o.overwrite = v == "yes";
       }},
  };
  return table;
}

std::string help() {
  std::string text =
      "usage: pack key=value ...\n\n"
      "Places bodies at random and writes a bodies' file for a case of simulate. Bodies get places one after the\n"
      "other; where there is no room for all of them, overlaps are removed. Discs in a box reach an area fraction\n"
      "of 0.75 and more. Values with spaces stand in quotes: shapes=\"1 1 0.7, 0.6 0.2 0.3\".\n\n";
  for (const Key& key : keys()) text += concat("  ", padded(key.name, 16), padded(key.standard, 12), key.help, "\n");
  return text;
}

void read(const std::string& argument, std::vector<std::string>& given, Options& options) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos) refuse(quote(argument), " has no '='; write key=value. --help lists the keys.");
  const std::string name(trim(argument.substr(0, equals))), value(trim(argument.substr(equals + 1)));
  std::vector<std::string> names;
  for (const Key& key : keys()) names.push_back(key.name);
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) refuse("unknown key ", quote(name), "; ", suggestion(name, names), "--help lists the keys.");
  if (std::find(given.begin(), given.end(), name) != given.end()) refuse(name, " is given twice; keep one.");
  if (value.empty()) refuse(name, " has no value.");
  given.push_back(name);
  try {
    keys()[at - names.begin()].set(options, value);
  } catch (const InputError& error) {
    refuse(name, " = ", quote(value), " ", error.what());
  }
}

// The keys that the domain needs, and those that have no effect there.
void check_domain(Options& options, const std::vector<std::string>& given) {
  Region& region = options.request.region;
  std::vector<std::string> needed;
  if (options.domain == "box")
    region.kind = RegionKind::box, needed = {"width"};
  else if (options.domain == "disc")
    region.kind = RegionKind::disc, needed = {"outer_radius"};
  else if (options.domain == "annulus")
    region.kind = RegionKind::annulus, needed = {"inner_radius", "outer_radius"};
  else
    refuse(options.domain.empty() ? "domain is missing" : concat("domain = ", quote(options.domain), " is unknown"),
           "; it can be box, disc or annulus.");
  const auto has = [&given](const std::string& key) { return std::find(given.begin(), given.end(), key) != given.end(); };
  for (const std::string& key : needed)
    if (!has(key)) refuse("domain = ", options.domain, " needs ", key, ".");
  if (region.kind == RegionKind::box) needed.push_back("height");
  for (const char* key : {"width", "height", "inner_radius", "outer_radius"})
    if (has(key) && std::find(needed.begin(), needed.end(), key) == needed.end())
      refuse(key, " does nothing with domain = ", options.domain, "; leave it out.");
  if (region.height == 0.0) region.height = region.width;
  if (region.kind == RegionKind::annulus && !(region.inner_radius < region.outer_radius))
    refuse("outer_radius = ", region.outer_radius, " must be greater than inner_radius = ", region.inner_radius, ".");
}

// A fiftieth of the smallest semi-axis where nothing is given.
void set_clearances(Options& options) {
  UniformRandom random(options.request.seed);
  double smallest = 1e300;
  for (const Shape& shape : requested_shapes(options.request, random)) smallest = std::min(smallest, shape.inradius());
  if (!options.has_body_clearance) options.request.clearance.bodies = 0.02 * smallest;
  if (!options.has_wall_clearance) options.request.clearance.walls = 0.02 * smallest;
}

std::string table(const Packing& packing, const std::string& made_by) {
  std::string text = concat("# made by: ", made_by, "\na,b,x,y,theta\n");
  for (const Body& body : packing.bodies)
    text += concat(body.shape.a, ",", body.shape.b, ",", body.pose.centre.real(), ",", body.pose.centre.imag(), ",",
                   body.pose.angle, "\n");
  return text;
}

// The result, and the keys of a case that belong to the bodies.
void report(const Packing& packing, const Options& options) {
  const Region& region = options.request.region;
  std::printf("%zu bodies, area fraction %s of an area of %s\n", packing.bodies.size(), brief(packing.area_fraction).c_str(),
              brief(region.area()).c_str());
  std::printf("smallest gap %s between bodies, %s to the edge%s\n", brief(packing.closest.gap).c_str(),
              brief(packing.wall_gap).c_str(), packing.relaxed ? "; overlaps were removed" : "");
  std::printf("\nFor the case, its file in the same folder:\n\n  bodies = %s\n",
              std::filesystem::path(options.output).filename().c_str());
  if (region.kind == RegionKind::box) {
    std::printf("  sample_area = %s\n", format_number(region.area()).c_str());
    return;
  }
  std::printf("  geometry = %s\n", options.domain.c_str());
  if (region.kind == RegionKind::annulus) std::printf("  inner_radius = %s\n", format_number(region.inner_radius).c_str());
  std::printf("  outer_radius = %s\n", format_number(region.outer_radius).c_str());
}

void run(const std::vector<std::string>& arguments) {
  Options options;
  options.request.shapes = {{{1.0, 1.0}, 1.0}};
  std::vector<std::string> given;
  for (const std::string& argument : arguments) read(argument, given, options);
  check_domain(options, given);
  set_clearances(options);
  if (!options.overwrite && std::filesystem::exists(options.output))
    refuse(options.output, " is there already; choose another output, or overwrite=yes.");
  const Packing packing = pack_bodies(options.request);
  std::string made_by = "pack";
  for (const std::string& argument : arguments)
    if (!argument.starts_with("output=") && !argument.starts_with("overwrite=")) made_by += " " + argument;
  write_file_atomically(options.output, table(packing, made_by));
  report(packing, options);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.empty() || arguments[0] == "--help" || arguments[0] == "-h") {
    std::fprintf(arguments.empty() ? stderr : stdout, "%s", help().c_str());
    return arguments.empty() ? 2 : 0;
  }
  try {
    run(arguments);
    return 0;
  } catch (const InputError& error) {
    std::fprintf(stderr, "pack: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pack: %s\n", error.what());
    return 3;
  }
}
