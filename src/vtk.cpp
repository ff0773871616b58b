#include "vtk.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>

#include "csv.hpp"
#include "curve.hpp"
#include "recorder.hpp"

namespace stokes {

namespace {

// Legacy VTK files hold their numbers with the most significant byte first.
template <class Bits>
void append_bits(std::string& text, Bits bits) {
  for (int shift = 8 * (sizeof(Bits) - 1); shift >= 0; shift -= 8) text += static_cast<char>((bits >> shift) & 0xFF);
}
void append(std::string& text, double value) { append_bits(text, std::bit_cast<std::uint64_t>(value)); }
void append(std::string& text, std::int32_t value) { append_bits(text, static_cast<std::uint32_t>(value)); }

template <class Number>
void append_all(std::string& text, const std::vector<Number>& values) {
  for (const Number value : values) append(text, value);
  text += '\n';
}

// Corners of the outlines, one after the other, and how many each has; the container's first.
struct Outlines {
  std::vector<double> points;  // x, y, 0 of each corner
  std::vector<std::int32_t> line, polygons;  // a count and the corners' numbers, for each outline

  void add(std::vector<std::int32_t>& cells, const Shape& shape, const Pose& pose, int corners, bool is_line) {
    const auto first = static_cast<std::int32_t>(points.size() / 3);
    cells.push_back(corners + (is_line ? 1 : 0));
    for (int k = 0; k < corners; ++k) cells.push_back(first + k);
    if (is_line) cells.push_back(first);
    const ComplexVector boundary = shape.curve(corners).position;
    for (const Complex z : boundary) {
      const Complex x = pose.centre + pose.axis() * z;
      points.insert(points.end(), {x.real(), x.imag(), 0.0});
    }
  }
};

// The data of each cell about its body.
struct CellData {
  std::vector<std::int32_t> body, fixed;
  std::vector<double> velocity, omega, contact_force, contact_torque;  // vectors have three components

  void add(int index, bool is_fixed, const RigidVelocity& u, const Wrench& contact) {
    body.push_back(index);
    fixed.push_back(is_fixed ? 1 : 0);
    velocity.insert(velocity.end(), {u.velocity.real(), u.velocity.imag(), 0.0});
    omega.push_back(u.omega);
    contact_force.insert(contact_force.end(), {contact.force.real(), contact.force.imag(), 0.0});
    contact_torque.push_back(contact.torque);
  }
};

template <class Number>
void append_array(std::string& text, const char* name, int components, const std::vector<Number>& values) {
  const char* const type = std::is_same_v<Number, double> ? " double\n" : " int\n";
  text += concat(name, " ", components, " ", values.size() / components, type);
  append_all(text, values);
}

CellData cell_data(const StepRecord& record) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const RigidVelocity unknown_velocity{{nan, nan}, nan};
  const Wrench unknown_wrench{{nan, nan}, nan};
  const StepOutcome* const outcome = record.outcome;
  CellData cells;
  const auto turning = [&record](const SurfaceMotion& surface) {
    return RigidVelocity{{}, record.driving * surface.angular_velocity};
  };
  if (const auto& container = record.bodies.container)
    cells.add(-1, true, outcome ? turning(container->surface) : unknown_velocity,
              outcome ? outcome->container_contact : unknown_wrench);
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    const Body& body = record.bodies[i];
    const RigidVelocity known = !outcome ? unknown_velocity : body.fixed ? turning(body.surface) : outcome->velocity[i];
    cells.add(static_cast<int>(i), body.fixed, known, outcome ? outcome->contact_wrench[i] : unknown_wrench);
  }
  return cells;
}

}  // namespace

std::string vtk_file(const StepRecord& record, int outline_points) {
  Outlines outlines;
  if (const auto& wall = record.bodies.container)
    outlines.add(outlines.line, {wall->radius, wall->radius}, {wall->centre, wall->angle}, 4 * outline_points, true);
  for (const Body& body : record.bodies) outlines.add(outlines.polygons, body.shape, body.pose, outline_points, false);
  const CellData cells = cell_data(record);

  std::string text = concat("# vtk DataFile Version 3.0\nstep ", record.step, ", time ", record.time,
                            "\nBINARY\nDATASET POLYDATA\nFIELD FieldData 1\n");
  append_array(text, "TIME", 1, std::vector<double>{record.time});
  text += concat("POINTS ", outlines.points.size() / 3, " double\n");
  append_all(text, outlines.points);
  if (!outlines.line.empty()) {
    text += concat("LINES 1 ", outlines.line.size(), "\n");
    append_all(text, outlines.line);
  }
  text += concat("POLYGONS ", record.bodies.size(), " ", outlines.polygons.size(), "\n");
  append_all(text, outlines.polygons);
  text += concat("CELL_DATA ", cells.body.size(), "\nFIELD FieldData 6\n");
  append_array(text, "body", 1, cells.body);
  append_array(text, "fixed", 1, cells.fixed);
  append_array(text, "velocity", 3, cells.velocity);
  append_array(text, "omega", 1, cells.omega);
  append_array(text, "contact_force", 3, cells.contact_force);
  append_array(text, "contact_torque", 1, cells.contact_torque);
  return text;
}

VtkWriter::VtkWriter(const std::filesystem::path& folder, int output_every)
    : folder_(made_folder(folder)), output_every_(output_every) {}

VtkWriter::~VtkWriter() {
  if (is_series_written_) return;
  try {
    write_series();
  } catch (const std::exception&) {  // the pictures exist, only their times are not listed
  }
}

void VtkWriter::write(const StepRecord& record) {
  if (record.outcome && record.step % output_every_ != 0) return;
  is_series_written_ = false;
  std::string number = std::to_string(record.step);
  number.insert(0, number.size() < 6 ? 6 - number.size() : 0, '0');
  write_file_atomically(folder_ / concat("step_", number, ".vtk"), vtk_file(record));
}

// The second line of a file is "step N, time T". Step numbers have leading zeros, so that longer names are later steps.
void VtkWriter::write_series() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    if (const std::string name = entry.path().filename().string(); name.starts_with("step_") && name.ends_with(".vtk"))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end(), [](const auto& p, const auto& q) {
    const std::string a = p.filename().string(), b = q.filename().string();
    return std::pair(a.size(), a) < std::pair(b.size(), b);
  });
  std::vector<std::string> entries;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    std::string line;
    std::getline(stream, line), std::getline(stream, line);
    const std::size_t time = line.find("time ");
    if (time == std::string::npos || !parse_number(std::string_view(line).substr(time + 5))) continue;
    entries.push_back(concat("{\"name\": \"", folder_.filename().string(), "/", file.filename().string(), "\", \"time\": ",
                             line.substr(time + 5), "}"));
  }
  write_file_atomically(folder_.parent_path() / "run.vtk.series",
                        concat("{\"file-series-version\": \"1.0\", \"files\": [\n", join(entries, ",\n"), "\n]}\n"));
  is_series_written_ = true;
}

}  // namespace stokes
