// plumb geometry: what a set of axes can and cannot determine, before anything is built.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>

#include "../io/text_tools.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/array/named.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/report/words.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

struct Options {
  std::string array;
  std::string name;
  bool json = false;
};

constexpr const char* kAbout =
    "Judge a geometry: the axes, how well they determine a vector, every group of three with its determinant\n"
    "and condition, and how many faulty sensors the array can isolate.";
constexpr const char* kNotes =
    "Built-in geometries for --name:\n"
    "  paper-tetrahedron   the paper's four axes (three on a cone about z, the fourth along z)\n"
    "  triad               orthogonal x, y, z\n"
    "  cone:5              five axes on a cone about z (any number from 3 up)\n"
    "  cone-axis:8         seven on a cone and one along z\n"
    "  platonic:6          one axis per pair of faces: 3 cube, 4 octahedron, 6 dodecahedron, 10 icosahedron\n\n"
    "Examples:\n"
    "  plumb geometry tool.toml\n"
    "  plumb geometry --name cone:5 --json\n\n"
    "Words: det = determinant of three unit axes (1 = orthogonal, 0 = in one plane); near singular = |det| below\n"
    "0.05, such a triple raises no alarm. Coplanarity c = most axes in one plane. Strict grade = faults that can be\n"
    "isolated for good; parity grade = faults that can be set aside without knowing gravity. Angles in deg.\n\n";

const std::vector<std::string> kNames = {"paper-tetrahedron", "triad", "cone", "cone-axis", "platonic"};

io::FileError usage(std::string what, std::string remedy) {
  return io::FileError{"--name", 0, "", std::move(what), std::move(remedy), io::ExitCode::usage};
}

io::FileExpected<SensorArray> array_of(const AxisList& axes, int n, const std::string& name) {
  if (n == 0) {
    return tl::unexpected<io::FileError>(
        usage("\"" + name + "\" does not exist",
              fmt::format("choose a number that this geometry has, from 3 to {}", kCapacity)));
  }
  std::array<SensorRow, kCapacity> rows{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    rows[i].id = make_id(fmt::format("a{}", i + 1).c_str());
    rows[i].axis = axes[i];
    rows[i].sigma_mps2 = 1e-3;  // the same for all: figures of merit do not depend on its size
  }
  const Expected<SensorArray> array = SensorArray::make(rows.data(), n);
  if (array) return *array;
  return tl::unexpected<io::FileError>(io::from_error(array.error()));
}

io::FileExpected<SensorArray> named_array(const std::string& name) {
  const std::size_t colon = name.find(':');
  const std::string kind = name.substr(0, colon);
  int n = 0;
  if (colon != std::string::npos) {
    const char* end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data() + colon + 1, end, n);
    if (error != std::errc() || stop != end) n = 0;
  }
  AxisList axes{};
  if (name == "paper-tetrahedron") return array_of(axes, paper_tetrahedron(axes), name);
  if (name == "triad") return array_of(axes, orthogonal_triad(axes), name);
  const bool fits = n >= 3 && n <= kCapacity;
  if (kind == "cone") return array_of(axes, fits ? cone(axes, n) : 0, name);
  if (kind == "cone-axis") return array_of(axes, fits ? cone_with_axis(axes, n) : 0, name);
  if (kind == "platonic") return array_of(axes, fits ? platonic(axes, n) : 0, name);
  return tl::unexpected<io::FileError>(usage(
      "\"" + name + "\" is not a geometry",
      io::did_you_mean(kind, kNames) + "choose one of paper-tetrahedron, triad, cone:5, cone-axis:8, platonic:6"));
}

std::string members(const SensorArray& array, const Triple& triple) {
  return report::sensor_names(triple.set(), array);
}

std::string text_of(const std::string& name, const SensorArray& array) {
  const FiguresOfMerit f = figures_of_merit(array);
  std::string out =
      fmt::format("{}: {} sensors\n\n  {:<15} {:>10} {:>10} {:>10}\n", name, array.size(), "sensor", "x", "y", "z");
  for (int i = 0; i < array.size(); ++i) {
    const Vec3& h = array.axis(i);
    out += fmt::format("  {:<15} {:>10.6f} {:>10.6f} {:>10.6f}\n", array.row(i).id.data(), h[0], h[1], h[2]);
  }
  out += fmt::format("\nnoise gain of the vector (GDOP)      {:.4f}\ncondition of the axes                {:.4f}\n",
                     f.gdop, f.condition);
  out += fmt::format("angle between the nearest two axes   {:.3f} deg\n", deg_from_rad(f.nearest_angle_rad));
  out += fmt::format("smallest |det| of a triple           {:.4f}\nworst condition of a triple          {:.4g}\n",
                     f.min_triple_det, f.max_triple_condition);
  out += fmt::format("a bias common to all, seen by parity {:.4f} (0 = not at all)\n", f.common_bias_visibility);
  out += fmt::format("most axes in one plane, c            {}\n", f.coplanarity);
  out += fmt::format("faults isolated for good (strict)    {}\nfaults set aside by parity alone     {}\n",
                     f.strict_grade, f.parity_grade);
  out += fmt::format("critical sensors                     {}\n",
                     report::sensor_names(critical_sensors(array, array.all()), array, "none"));
  out +=
      fmt::format("near-singular triples                {} of {}\n\n", f.near_singular_triples, array.triple_count());
  out += fmt::format("  {:>9} {:>11}  {:<14}  {}\n", "det", "condition", "", "triple");
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    out += fmt::format("  {:>9.5f} {:>11.4g}  {:<14}  {}\n", t.det, t.condition, t.votes ? "" : "near singular",
                       members(array, t));
  }
  return out;
}

std::string json_of(const std::string& name, const SensorArray& array) {
  using Json = nlohmann::ordered_json;
  const FiguresOfMerit f = figures_of_merit(array);
  const auto ids = [&array](SensorSet set) {
    Json list = Json::array();
    for (int i = 0; i < array.size(); ++i) {
      if (set.has(i)) list.push_back(array.row(i).id.data());
    }
    return list;
  };
  Json out;
  out["name"] = name;
  Json sensors = Json::array();
  for (int i = 0; i < array.size(); ++i) sensors.push_back({{"id", array.row(i).id.data()}, {"axis", array.axis(i)}});
  out["sensors"] = std::move(sensors);
  out["figures_of_merit"] = {{"gdop", f.gdop},
                             {"condition", f.condition},
                             {"nearest_angle_deg", deg_from_rad(f.nearest_angle_rad)},
                             {"min_triple_det", f.min_triple_det},
                             {"max_triple_condition", f.max_triple_condition},
                             {"common_bias_visibility", f.common_bias_visibility},
                             {"coplanarity", f.coplanarity},
                             {"strict_grade", f.strict_grade},
                             {"parity_grade", f.parity_grade},
                             {"near_singular_triples", f.near_singular_triples}};
  out["critical_sensors"] = ids(critical_sensors(array, array.all()));
  Json triples = Json::array();
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    triples.push_back(
        {{"sensors", ids(t.set())}, {"det", t.det}, {"condition", t.condition}, {"near_singular", !t.votes}});
  }
  out["triples"] = std::move(triples);
  return out.dump(2) + "\n";
}

io::ExitCode run(const Options& options) {
  if (options.array.empty() == options.name.empty()) {
    return report(io::FileError{"geometry", 0, "",
                                options.name.empty() ? "nothing to judge" : "both a file and --name are given",
                                "give an array file, or --name paper-tetrahedron", io::ExitCode::usage});
  }
  std::string name = options.name;
  io::FileExpected<SensorArray> array = tl::unexpected<io::FileError>(io::FileError{});
  if (options.array.empty()) {
    array = named_array(options.name);
  } else {
    io::FileExpected<io::ArrayFile> file = io::read_array_file(options.array);
    if (!file) return report(file.error());
    name = file->name;
    array = file->array;
  }
  if (!array) return report(array.error());
  print(options.json ? json_of(name, *array) : text_of(name, *array));
  return io::ExitCode::done;
}

}  // namespace

Command add_geometry(CLI::App& tool) {
  auto options = std::make_shared<Options>();
  CLI::App* app =
      tool.add_subcommand("geometry", "judge a set of axes: what it determines, and how many faults it can isolate");
  app->add_option("array", options->array, "the array file to judge")->type_name("ARRAY.toml");
  app->add_option("--name", options->name, "a built-in geometry instead of a file, see below")->type_name("NAME");
  app->add_flag("--json", options->json, "JSON instead of text, for machines");
  app->footer(kNotes + exit_codes_help());
  return {app, kAbout, [options] { return run(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
