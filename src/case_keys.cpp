#include "case_keys.hpp"

#include <limits>
#include <type_traits>

#include "text.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

template <class Value>
using Words = std::vector<std::pair<std::string, Value>>;

Words<Geometry> words_of(Geometry) {
  return {{"unbounded", Geometry::unbounded}, {"disc", Geometry::disc}, {"annulus", Geometry::annulus}};
}
Words<FlowKind> words_of(FlowKind) {
  return {{"shear", FlowKind::shear},
          {"extension", FlowKind::extension},
          {"linear", FlowKind::linear},
          {"poiseuille", FlowKind::poiseuille},
          {"taylor_green", FlowKind::taylor_green},
          {"none", FlowKind::none}};
}
Words<ContactModel> words_of(ContactModel) {
  return {{"gap", ContactModel::gap}, {"stiv", ContactModel::stiv}, {"none", ContactModel::none}};
}
Words<Coupling> words_of(Coupling) {
  return {{"global", Coupling::global}, {"local", Coupling::local}};
}
Words<LcpMatrix> words_of(LcpMatrix) {
  return {{"full", LcpMatrix::full}, {"near", LcpMatrix::near}, {"self", LcpMatrix::self}};
}
Words<StivGradient> words_of(StivGradient) {
  return {{"full", StivGradient::full}, {"frozen", StivGradient::frozen}};
}
Words<NearSingular> words_of(NearSingular) {
  return {{"cauchy", NearSingular::cauchy}, {"interpolation", NearSingular::interpolation}};
}
Words<IntegratorKind> words_of(IntegratorKind) {
  return {{"euler", IntegratorKind::euler}, {"ab2", IntegratorKind::ab2}, {"rk3", IntegratorKind::rk3},
          {"midpoint", IntegratorKind::midpoint}};
}
Words<TimeCounting> words_of(TimeCounting) {
  return {{"accumulated", TimeCounting::accumulated}, {"exact", TimeCounting::exact}};
}
Words<Refine> words_of(Refine) { return {{"none", Refine::none}, {"near", Refine::near}}; }
Words<Summation> words_of(Summation) {
  return {{"auto", Summation::automatic}, {"direct", Summation::direct}, {"fmm", Summation::fmm}};
}
Words<bool> words_of(bool) { return {{"yes", true}, {"no", false}}; }

template <class Value>
std::vector<std::string> names_of(const Words<Value>& words) {
  std::vector<std::string> names;
  for (const auto& word : words) names.push_back(word.first);
  return names;
}

template <class Value>
Value parse_value(const std::string& key, const GivenValue& given) {
  if constexpr (std::is_same_v<Value, std::string>) {
    if (given.text == "~" || given.text.starts_with("~/"))
      refuse(key, given, "begins with '~', which only a shell replaces; write the whole name of the folder.");
    return given.text;
  } else if constexpr (std::is_same_v<Value, double>) {
    if (const auto number = parse_number(given.text)) return *number;
    refuse(key, given, "is not a finite number; write it like 0.25 or 1e-3.");
  } else if constexpr (std::is_same_v<Value, int>) {
    constexpr long long limit = std::numeric_limits<int>::max();
    const auto number = parse_integer(given.text);
    if (number && *number >= -limit && *number <= limit) return static_cast<int>(*number);
    refuse(key, given, concat("is not a whole number of at most ", limit, "; write it like 32."));
  } else if constexpr (std::is_same_v<Value, std::vector<double>>) {
    Value values;
    if (given.text == "none") return values;
    for (const std::string_view piece : split(given.text, ' ')) {
      if (trim(piece).empty()) continue;
      const auto number = parse_number(trim(piece));
      if (!number)
        refuse(key, given, concat("has ", quote(piece), ", which is not a finite number; write it like 0 0.5 2."));
      values.push_back(*number);
    }
    return values;
  } else {
    const auto words = words_of(Value{});
    for (const auto& [name, value] : words)
      if (name == given.text) return value;
    const auto names = names_of(words);
    refuse(key, given,
           concat("is unknown: it can be ", join(names, " or "), "; ", hint_for(given.text),
                  suggestion(given.text, names), "--help explains them."));
  }
}

template <class Value>
std::string text_of(const Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    return value.empty() ? "none" : value;
  } else if constexpr (std::is_same_v<Value, std::vector<double>>) {
    std::vector<std::string> texts;
    for (const double number : value) texts.push_back(format_number(number));
    return texts.empty() ? "none" : join(texts, " ");
  } else if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
    return format_number(value);
  } else {
    for (const auto& [name, known] : words_of(value))
      if (known == value) return name;
    throw std::logic_error("a value of the case has no word");
  }
}

template <class Value>
std::string kind_of() {
  if constexpr (std::is_same_v<Value, std::string>)
    return "name";
  else if constexpr (std::is_same_v<Value, double>)
    return "number";
  else if constexpr (std::is_same_v<Value, int>)
    return "whole number";
  else if constexpr (std::is_same_v<Value, std::vector<double>>)
    return "numbers | none";
  else
    return join(names_of(words_of(Value{})), " | ");
}

template <class Value>
CaseKey optional(std::string name, Value Case::*member, std::string help) {
  const auto set = [=](Case& c, const GivenValue& given) { c.*member = parse_value<Value>(name, given); };
  const auto get = [=](const Case& c) { return text_of(c.*member); };
  return {name, Needed::never, {}, kind_of<Value>(), std::move(help), set, get};
}

template <class Value>
CaseKey required(std::string name, Value Case::*member, std::string help, Needed needed = Needed::always) {
  CaseKey key = optional(std::move(name), member, std::move(help));
  key.needed = needed;
  return key;
}

CaseKey where(Condition condition, CaseKey key) {
  key.conditions.push_back(std::move(condition));
  return key;
}

CaseKey in_annulus(CaseKey key) {
  key.help = "in an annulus: " + key.help;
  return where({"geometry", [](const Case& c) { return c.geometry == Geometry::annulus; },
                "belongs to an annulus; write geometry = annulus or leave it out."},
               std::move(key));
}

CaseKey between_walls(CaseKey key) {
  key.help = "in an annulus or disc: " + key.help;
  return where(
      {"geometry", [](const Case& c) { return c.geometry != Geometry::unbounded; },
       "belongs to an annulus or disc, but the geometry is unbounded; write geometry = annulus or disc, or leave it "
       "out."},
      std::move(key));
}

CaseKey in_unbounded(CaseKey key) {
  return where({"geometry", [](const Case& c) { return c.geometry == Geometry::unbounded; },
                "belongs to a flow of unbounded fluid, but in an annulus or disc the walls drive the fluid; leave it out."},
               std::move(key));
}

CaseKey without_earlier(CaseKey key) {
  return where({"start_from", [](const Case& c) { return c.start_from.empty(); },
                "does nothing with start_from; leave it out."},
               std::move(key));
}

CaseKey with_contact(CaseKey key) {
  return where({"contact", [](const Case& c) { return c.contact != ContactModel::none; },
                "does nothing with contact = none; leave it out."},
               std::move(key));
}

CaseKey with_stiv(CaseKey key) {
  return where({"contact", [](const Case& c) { return c.contact == ContactModel::stiv; },
                "does nothing without contact = stiv; leave it out."},
               std::move(key));
}

// A key that need not have a value: `unset` is the word for that.
template <class Value>
CaseKey optional(std::string name, std::optional<Value> Case::*member, std::string unset, std::string help) {
  const auto set = [=](Case& c, const GivenValue& given) {
    c.*member = given.text == unset ? std::nullopt : std::optional(parse_value<Value>(name, given));
  };
  const auto get = [=](const Case& c) { return c.*member ? text_of(*(c.*member)) : unset; };
  return {name, Needed::never, {}, kind_of<Value>() + " | " + unset, std::move(help), set, get};
}

}  // namespace

std::string hint_for(std::string_view word) {
  constexpr std::pair<std::string_view, std::string_view> hints[] = {
      {"dt", "the length of a step is time_step; "},
      {"tmax", "the end is end_time; "},
      {"tend", "the end is end_time; "},
      {"steps", "the number of steps follows from end_time and time_step; "},
      {"tol", "the tolerance of a solve is gmres_tolerance; "},
      {"delta", "the separation is min_separation_length, or min_separation in units of h; "},
      {"n", "the nodes on a body are points_per_body; "},
      {"radius", "bodies have the columns a and b, walls have inner_radius and outer_radius; "},
      {"omega", "walls have inner_angular_velocity and outer_angular_velocity; "},
      {"viscosity", "the viscosity is 1, which sets the unit of force; "},
      {"seed", "nothing is random here, build/pack makes random starts; "},
      {"period", "there are no periodic domains; "},
      {"periodic", "there are no periodic domains; "},
      {"box", "there are no boxes; "},
      {"channel", "there are no channels: flow = poiseuille is that between walls far away, and walls are circles; "},
      {"restart", "an interrupted run goes on with the same command, another one from start_from = FOLDER; "},
      {"couette", "the flow between cylinders is geometry = annulus with walls that turn; "},
  };
  for (const auto& [known, hint] : hints)
    if (edit_distance(word, known) <= (known.size() > 5 ? 1 : 0)) return std::string(hint);
  return {};
}

const std::vector<CaseKey>& case_keys() {
  static const std::vector<CaseKey> table = {
      without_earlier(required("bodies", &Case::bodies, "CSV of the bodies, its path relative to the case file")),
      optional("start_from", &Case::start_from,
               "instead of bodies: FOLDER or FOLDER TIME, the last state of the run there, or that of a time in its "
               "trajectory.csv; the time goes on from there"),
      required("flow", &Case::flow,
               "background: shear (rate y, 0), extension rate (x, -y), linear rate (a x + b y, c x + d y), "
               "poiseuille (rate y^2, 0), taylor_green rate (cos x sin y, -sin x cos y); none in an annulus or disc",
               Needed::unbounded),
      required("time_step", &Case::time_step, "length of a step, time"),
      required("end_time", &Case::end_time, "when to stop, time"),
      required("output", &Case::output, "folder of the results, relative to the working directory"),
      without_earlier(optional("start_time", &Case::start_time, "time at the beginning")),
      optional("geometry", &Case::geometry, "of the fluid; annulus and disc are centred at 0"),
      in_annulus(required("inner_radius", &Case::inner_radius, "of the inner wall, length", Needed::annulus)),
      between_walls(required("outer_radius", &Case::outer_radius, "of the outer wall, length", Needed::walls)),
      between_walls(optional("wall_points", &Case::wall_points, "nodes on each wall, even, at least 16")),
      between_walls(optional("outer_angular_velocity", &Case::outer_angular_velocity, "of the outer wall, 1/time")),
      in_annulus(optional("inner_angular_velocity", &Case::inner_angular_velocity, "of the inner wall, 1/time")),
      in_annulus(optional("injection_rate", &Case::injection_rate, "through both walls, outwards, area/time")),
      where({"flow", [](const Case& c) { return c.flow != FlowKind::none; }, "does nothing with flow = none; leave it out."},
            in_unbounded(
                optional("rate", &Case::rate, "of the flow, 1/time, of poiseuille 1/(length time); may be negative"))),
      where({"flow", [](const Case& c) { return c.flow == FlowKind::linear; },
             "does nothing without flow = linear; leave it out."},
            in_unbounded(optional("gradient", &Case::gradient,
                                  "of flow = linear: a b c d, that is du/dx du/dy dv/dx dv/dy, with a + d = 0"))),
      where({"flow", [](const Case& c) { return c.background().has_uniform_gradient(); },
             "needs a flow of uniform gradient: shear, extension or linear; leave it out."},
            in_unbounded(optional("sample_area", &Case::sample_area, "none",
                                  "area that the bodies stand for, such as that of their box: makes bulk_stress_11, "
                                  "bulk_stress_12 and effective_viscosity of steps.csv"))),
      optional(
          "accuracy", &Case::accuracy, "none",
          "of the bodies' velocities, in units of the rate and size of what drives them: chooses the nodes of bodies and "
          "walls and the tolerance of the solver at every step; 1e-4 without points_per_body"),
      optional("points_per_body", &Case::points_per_body, "nodes on each body, even, at least 8; 0: chosen by accuracy"),
      optional("reverse_at", &Case::reverse_at, "none",
               "time from which the flow and the walls' velocities are reversed; forces on bodies are not"),
      with_contact(optional("min_separation", &Case::min_separation,
                            "in units of h = longest perimeter of a body / points_per_body")),
      with_contact(
          optional("min_separation_length", &Case::min_separation_length, "none", "length, instead of min_separation")),
      optional("contact", &Case::contact, "model that keeps bodies apart"),
      optional("coupling", &Case::coupling, "local: densities of the other bodies are those of the step before"),
      with_contact(optional("lcp_matrix", &Case::lcp_matrix, "mobility in the contact problem's matrix")),
      with_stiv(optional("stiv_vertices", &Case::stiv_vertices,
                         "of each polygon with contact = stiv, 8 to 65536; 0: 4 points_per_body")),
      with_stiv(
          optional("stiv_gradient", &Case::stiv_gradient, "of the interference volume; frozen holds the hit time fixed")),
      optional("near_singular", &Case::near_singular, "evaluation close to a boundary"),
      optional("gmres_tolerance", &Case::gmres_tolerance, "relative true residual, between 0 and 1"),
      optional("refine", &Case::refine, "near: more nodes where bodies are too close for points_per_body"),
      optional("summation", &Case::summation,
               "of the flows of all nodes; auto: direct for few of them; fmm to a tenth of gmres_tolerance, 1e-12 at best"),
      optional(
          "integrator", &Case::integrator,
          "of the time steps: euler, first order, the paper's; ab2, second order at the same price; rk3, third order, three "
          "times the price; midpoint, implicit: without contact a reversed flow takes the bodies back exactly"),
      optional("adaptive", &Case::adaptive, "reject and halve time steps that fail"),
      where({"integrator", [](const Case& c) { return c.integrator == IntegratorKind::rk3; },
             "needs integrator = rk3, whose error is estimated; write it, or leave the tolerance out."},
            optional(
                "tolerance", &Case::tolerance, "none",
                "of the local error of a step, in largest semi-axes and radians: chooses the steps, of which time_step is "
                "the first and largest")),
      optional("output_every", &Case::output_every, "steps between rows of trajectory.csv"),
      optional("fields_at", &Case::fields_at,
               "increasing times; fields_TIME.csv holds the flow of the first state then or after"),
      where(
          {"fields_at", [](const Case& c) { return !c.fields_at.empty(); }, "does nothing without fields_at; leave it out."},
          optional("field_points", &Case::field_points, "of the flow written out, on each side of its grid")),
      optional("overwrite", &Case::overwrite, "yes: replace the results of another run in the output folder"),
      optional("vtk", &Case::vtk, "OUTPUT/vtk/step_NUMBER.vtk for ParaView at every output_every-th step and the end"),
      optional("checkpoint_every", &Case::checkpoint_every, "seconds between checkpoints; 0: none at intervals"),
      optional("threads", &Case::threads, "all", concat("at most ", most_threads)),
      where({"adaptive", [](const Case& c) { return !c.adaptive; }, "does nothing with adaptive = yes; leave it out."},
            optional("time_counting", &Case::time_counting, "exact: the last step ends at end_time")),
  };
  return table;
}

}  // namespace stokes
