// plumb demo: what plumb does, in six sections, on simulated tools. No file needed.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <vector>

#include "demo_section.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/render/page.hpp"
#include "plumb/scenario/library.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

struct DemoOptions {
  std::string out = "plumb-demo";
  std::uint64_t seed = 1;
};

/// In the order of the page.
constexpr std::array<io::FileExpected<DemoSection> (*)(const DemoContext&), 6> kSections = {
    demo_geometry, demo_calibration, demo_gravity_error, demo_table2, demo_drill_a, demo_drill_b,
};

constexpr const char* kDemoAbout =
    "Show what plumb does, without any file of yours: simulated tools are calibrated and monitored while their\n"
    "accelerometers fail. Writes an index page with pictures, and all its data as JSON and CSV.";
constexpr const char* kDemoNotes =
    "Examples:\n"
    "  plumb demo\n"
    "  plumb demo --out /tmp/demo --seed 7\n\n"
    "Then open plumb-demo/index.html. The same seed gives the same bytes. Another seed draws other tools,\n"
    "other noise and other attitudes. The pictures need gnuplot; without it the rest is still written.\n\n";

io::FileExpected<void> make_directory(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!error) return {};
  return tl::unexpected<io::FileError>(io::FileError{path, 0, "", "cannot create the directory: " + error.message(),
                                                     "choose another directory with --out", io::ExitCode::other});
}

constexpr std::size_t kDrills = 2;
/// In the order of their work, the drills first: the page opens with what they show.
constexpr std::array<std::size_t, kSections.size()> kWorkOrder = {4, 5, 0, 1, 2, 3};

/// What it comes to, ahead of how it comes about.
render::Chapter result_of(const std::vector<const DemoSection*>& drills, std::string& console) {
  render::Chapter out;
  out.id = "result";
  out.title = "The result";
  out.gist = "How wrong the inclination gets when sensors fail, without plumb and with it.";
  out.text = {
      "Two surveys during which accelerometers fail. Without plumb the tool goes on as if nothing had happened: the "
      "plain least-squares answer of all its sensors. With plumb every output that is published as valid or degraded "
      "stays right. Each figure is the worst of its run; the drills below show it block by block."};
  for (const DemoSection* drill : drills) {
    const auto figure = [drill](const char* key) { return drill->facts[key].get<double>(); };
    const double without_deg = figure("worst_inclination_error_without_plumb_deg"),
                 with_deg = figure("worst_inclination_error_valid_or_degraded_deg");
    const std::string name = drill->chapter.title.substr(drill->chapter.title.find(' ') + 1);
    out.figures.push_back({fmt::format("{:.2g}°", without_deg), name + ": wrong by, without plumb", "bad"});
    out.figures.push_back({fmt::format("{:.2g}°", with_deg), name + ": wrong by, with plumb", "good"});
    console += fmt::format("{}: inclination wrong by {:.2g} deg without plumb, by {:.2g} deg with it\n", name,
                           without_deg, with_deg);
  }
  return out;
}

/// Why pictures are missing, or nothing.
std::string missing_picture(const render::Page& page) {
  for (const render::Chapter& chapter : page.chapters) {
    for (const render::Picture& picture : chapter.pictures) {
      if (picture.svg.empty()) return picture.missing;
    }
  }
  return "";
}

io::ExitCode run_demo(const DemoOptions& options) {
  const io::FileExpected<void> made = make_directory(options.out);
  if (!made) return report(made.error());
  const DemoContext context{options.out, options.seed, scenario::paper_tool(options.seed)};
  render::Page page;
  page.title = "plumb demo";
  page.lead =
      "plumb monitors redundant accelerometers: it calibrates them from gravity, tests every combination of them, "
      "excludes the faulty ones, and states at every sample what is valid. All figures below were measured on "
      "simulated tools, drawn from one seed.";
  page.footer = fmt::format(
      "plumb {}, seed {}: the same seed gives the same bytes. `plumb demo --seed 2` draws other tools, other noise and "
      "other attitudes. demo.json holds every figure of this page. g0 = 9.80665 m/s², mg0 = g0/1000.",
      kVersion, options.seed);
  nlohmann::ordered_json facts;
  facts["seed"] = options.seed;
  facts["version"] = kVersion;
  print(fmt::format("plumb demo, seed {}\n\n", options.seed));
  std::array<DemoSection, kSections.size()> sections;
  std::vector<const DemoSection*> drills;
  for (const std::size_t k : kWorkOrder) {
    io::FileExpected<DemoSection> done = kSections[k](context);
    if (!done) return report(done.error());
    sections[k] = *std::move(done);
    if (drills.size() < kDrills) {
      drills.push_back(&sections[k]);
      if (drills.size() < kDrills) continue;
      std::string result;
      page.chapters.push_back(result_of(drills, result));
      print_now(result + "\n");
    } else {
      print_now(sections[k].console);
    }
  }
  for (const DemoSection* drill : drills) print_now(drill->console);
  for (DemoSection& section : sections) {
    facts["sections"][section.chapter.id] = std::move(section.facts);
    page.chapters.push_back(std::move(section.chapter));
  }
  const auto path = [&options](const char* name) { return (std::filesystem::path(options.out) / name).string(); };
  io::FileExpected<void> written = io::write_file(path("demo.json"), facts.dump(1) + "\n");
  if (written) written = io::write_file(path("index.html"), render::page_html(page));
  if (!written) return report(written.error());
  const std::string missing = missing_picture(page);
  if (!missing.empty()) print_error("plumb: " + missing + "\n");
  print(fmt::format("\nwritten to {}: index.html (open this), demo.json, and the files that the page links\n",
                    options.out));
  return io::ExitCode::done;
}

}  // namespace

Command add_demo(const Options& tool) {
  auto options = std::make_shared<DemoOptions>();
  const Options command = tool.add_command("demo", "what plumb does, on simulated tools; needs no file");
  command.add_option("--out", options->out, "the directory to write to, plumb-demo by default").type_name("DIR");
  command.add_option("--seed", options->seed, "which tools, noise and attitudes are drawn, 1 by default")
      .check(seed_refusal)
      .type_name("N");
  command.footer(kDemoNotes + exit_codes_help());
  return {command, kDemoAbout, [options] { return run_demo(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
