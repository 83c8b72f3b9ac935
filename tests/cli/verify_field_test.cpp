// plumb verify of a magnetic group: what it finds is what it finds of accelerometers, and it is told in nT.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "render/verify_support.hpp"

namespace verify_field_test {
namespace {

using namespace plumb_test;

const std::string kExamples = std::string(PLUMB_SOURCE_DIR) + "/examples/";

/// Accelerometers and magnetometers of the same axes, noise, priors and bounds: 4 uT for every m/s^2. Their length is
/// g0, of which the faults of a report are parts.
std::string twins() {
  std::string text =
      "name = \"twin\"\n[gravity]\nmodel = \"value\"\nvalue = \"9.80665 m/s^2\"\nsigma = \"0.01 m/s^2\"\n[input]\n"
      "reads = \"gravity\"\nunit = \"m/s^2\"\nrate = \"50 Hz\"\n[monitor]\nalert_limit = \"2 deg\"\n"
      "stability = \"0.002 m/s^2\"\nacceleration_bound = \"0.01 m/s^2\"\n";
  std::string group =
      "[[group]]\nname = \"mag\"\nfield = \"magnetic\"\nunit = \"nT\"\n[group.reference]\nvalue = \"39.2266 uT\"\n"
      "sigma = \"40 nT\"\n[group.monitor]\nalert_limit = \"2 deg\"\nstability = \"8 nT\"\n"
      "disturbance_bound = \"40 nT\"\n";
  const char* const axes[] = {"[1, 0, 0]", "[0, 0.6, 0.8]", "[0, -0.6, 0.8]", "[0.6, 0.8, 0]", "[0.8, 0, -0.6]"};
  for (std::size_t i = 0; i < 5; ++i) {
    const std::string n = std::to_string(i + 1), axis = std::string("axis = ") + axes[i] + "\n";
    text += "[[sensor]]\nid = \"a" + n + "\"\n" + axis +
            "noise = \"0.005 m/s^2\"\nprior = {bias = \"0.125 m/s^2\", scale = \"2 %\", axis = \"2 deg\"}\n";
    group += "[[group.sensor]]\nid = \"m" + n + "\"\n" + axis +
             "noise = \"20 nT\"\nprior = {bias = \"500 nT\", scale = \"2 %\", axis = \"2 deg\"}\n";
  }
  return text + group;
}

const Directory& twin_reports() {
  static const Directory* const made = [] {
    auto* where = new Directory;
    write_text(*where / "tool.toml", twins());
    write_text(*where / "a.toml",
               "[limits]\nfault = \"0.5 m/s^2\"\nfalse_alarm_rate = 0.01\ndetect_within = \"60 s\"\n");
    write_text(*where / "m.toml", "[limits]\nfault = \"2000 nT\"\nfalse_alarm_rate = 0.01\ndetect_within = \"60 s\"\n");
    const Outcome a = verify(*where, {"--array", "tool.toml", "--limits", "a.toml", "--out", "a"}, "400");
    const Outcome m = verify(*where, {"--array", "tool.toml#mag", "--limits", "m.toml", "--out", "m"}, "400");
    EXPECT_EQ(a.code, 6) << a.err;  // their calibration is but predicted
    EXPECT_EQ(m.code, 6) << m.err;
    write_text(*where / "m.out", m.out + m.err);
    return where;
  }();
  return *made;
}

bool near(double a, double b) { return std::fabs(a - b) <= 1e-6 * std::max(std::fabs(a), std::fabs(b)) + 1e-12; }

/// Every number of the one, times what the unit of its key is of the other's.
void expect_scaled(const Json& a, const Json& m, const std::string& path, int& compared, double factor = 1.0) {
  ASSERT_EQ(a.type() == Json::value_t::null, m.type() == Json::value_t::null) << path;
  if (a.is_number()) {
    ++compared;
    EXPECT_TRUE(near(factor * a.get<double>(), m.get<double>())) << path << ": " << a << " and " << m;
    return;
  }
  ASSERT_EQ(a.size(), m.size()) << path;
  if (a.is_array()) {
    for (std::size_t k = 0; k < a.size(); ++k)
      expect_scaled(a[k], m[k], path + "[" + std::to_string(k) + "]", compared, factor);
  }
  if (!a.is_object()) return;
  auto other = m.begin();
  for (auto item = a.begin(); item != a.end(); ++item, ++other) {
    const std::string& key = item.key();
    const auto ends = [&key](const std::string& end) {
      return key.size() >= end.size() && key.compare(key.size() - end.size(), end.size(), end) == 0;
    };
    const double of_key = ends("_per_mps2") ? 1.0 / 4000.0 : ends("_mps2_2") ? 16e6 : ends("_mps2") ? 4000.0 : factor;
    // At round noises of its own; of g0; in the units of the log.
    if (key == "protection_levels" || key == "attitude_map" || key == "expected_raw" || key == "scale_per_g0") continue;
    expect_scaled(*item, *other, path + "." + key, compared, of_key);
  }
}

// Verifies: REQ-254
// A law of the whole report: with readings, noise, priors, bounds and faults times one factor, sizes take it, and
// rates, states and angles stay as they are.
TEST(VerifyOfAField, IsThatOfTheSameAxesInGravityScaled) {
  Json a = report_in(twin_reports() / "a"), m = report_in(twin_reports() / "m");
  for (Json* const one : {&a, &m}) {  // what accelerometers alone have, and what is told in other words
    (*one)["array"].erase("reads");
    (*one)["calibration"]["fit"].erase("paper_parameters");
    for (const char* const key : {"wiring", "alignment"}) {
      (*one)["calibration"]["fit"].erase(key);
      (*one)["calibration"].erase(key);
    }
  }
  int compared = 0;
  for (const char* const section : {"array", "campaign", "calibration"})
    expect_scaled(a[section], m[section], section, compared);
  EXPECT_GT(compared, 3000);
  EXPECT_EQ(a["state_machine"], m["state_machine"]) << "the states that were gone through, and how often";
  ASSERT_EQ(a["verdict"]["criteria"].size(), m["verdict"]["criteria"].size());
  for (std::size_t k = 0; k < a["verdict"]["criteria"].size(); ++k) {
    EXPECT_EQ(a["verdict"]["criteria"][k]["id"], m["verdict"]["criteria"][k]["id"]);
    EXPECT_EQ(a["verdict"]["criteria"][k]["result"], m["verdict"]["criteria"][k]["result"]);
  }
  const std::string of_a = read_text(twin_reports() / "a" / "trials-faults.csv"),
                    of_m = read_text(twin_reports() / "m" / "trials-faults.csv");
  EXPECT_EQ(std::count(of_a.begin(), of_a.end(), '\n'), std::count(of_m.begin(), of_m.end(), '\n'));
}

void each_text(const Json& value, const std::function<void(const std::string&)>& see) {
  if (value.is_string()) see(value.get<std::string>());
  if (!value.is_structured()) return;
  for (auto item = value.begin(); item != value.end(); ++item) {
    if (value.is_object()) see(item.key());
    each_text(*item, see);
  }
}

bool has_word(const std::string& text, const std::string& word) {
  const auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !letter(text[at - 1])) && (end == text.size() || !letter(text[end]))) return true;
  }
  return false;
}

const std::vector<std::string>& words_of_gravity() {
  static const std::vector<std::string> words = {"mg0", "g0", "m/s^2", "mps2", "gravity", "Gravity", "acceleration"};
  return words;
}

// Verifies: REQ-254
TEST(VerifyOfAField, SpeaksOfTheFieldEverywhere) {
  const Json m = report_in(twin_reports() / "m");
  EXPECT_EQ(m["subject"]["field"], "magnetic");
  EXPECT_FALSE(report_in(twin_reports() / "a")["subject"].contains("field"));
  EXPECT_NEAR(m["array"]["field_nt"].get<double>(), 39226.6, 1e-6);
  EXPECT_NEAR(m["array"]["sensors"][0]["sigma_nt"].get<double>(), 20.0, 1.0);
  EXPECT_EQ(m["array"]["attitude_map"]["columns"][2], "guaranteed_above_ut");
  for (const char* const section : {"verdict", "array", "calibration", "campaign"}) {
    each_text(m[section], [section](const std::string& text) {
      for (const std::string& word : words_of_gravity())
        EXPECT_FALSE(has_word(text, word)) << section << ", " << word << ": " << text;
    });
  }
  const std::string toml = read_text(twin_reports() / "m" / "faults.toml");
  EXPECT_TRUE(says(toml, {"field = \"magnetic\"", "array.toml#mag", "[reference]", "39.2266 uT", "disturbance_bound",
                          "stuck=-39.2266uT", "drift=0.0392266uT/s", "bias=1.96133uT+station2"}));
  const std::string shown = read_text(twin_reports() / "m.out");
  EXPECT_TRUE(says(shown, {"INCONCLUSIVE", "Wiring confirmed by the accelerometers", "same residuals", " nT"}));
  for (const std::string& word : words_of_gravity()) EXPECT_FALSE(has_word(shown, word)) << word << "\n" << shown;
}

// Verifies: REQ-254
TEST(VerifyOfAField, ThePageIsInNanoteslaAndOfDirections) {
  const std::string page = read_text(twin_reports() / "m" / "report.html");
  const std::size_t machine = page.find("<section id=\"machine\""), change = page.find("<section id=\"change\"");
  ASSERT_NE(machine, std::string::npos);
  ASSERT_NE(change, std::string::npos);
  const std::string of_array = page.substr(page.find("<body"), machine - page.find("<body")) + page.substr(change);
  for (const char* const word :
       {"noise of a sample, nT", "What it leaves, nT", "error of the direction",
        "A steady disturbance of the field of at most 40 nT is allowed for", "The magnetic field is 39.227 uT",
        "Angles are of the direction of the field in the tool", "MDB of a campaign", "nT = 0.001 uT",
        "aligned to the accelerometers"})
    EXPECT_NE(of_array.find(word), std::string::npos) << word;
  std::vector<std::string> wrong = words_of_gravity();
  wrong.insert(wrong.end(), {"inclination", "toolface", "tilt", "standstill"});
  for (const std::string& word : wrong) {
    std::size_t at = of_array.find(word);
    EXPECT_FALSE(has_word(of_array, word)) << word << ": ..." << of_array.substr(at > 60 ? at - 60 : 0, 160);
  }
}

// Verifies: REQ-254
TEST(VerifyOfAField, ItsScenariosAreRunAgainInTheDirectory) {
  const Json m = report_in(twin_reports() / "m");
  EXPECT_EQ(m["campaign"]["replayed"]["agree"], m["campaign"]["replayed"]["scenarios"]);
  Directory here;
  for (const char* const name : {"array.toml", "faults.toml"})
    std::filesystem::copy_file(twin_reports() / "m" / name, here / name);
  const Outcome again = run(here, {"campaign", "faults.toml", "--replay", "3"});
  EXPECT_EQ(again.code, 0) << again.err;
  const Outcome whole = run(here, {"campaign", "faults.toml", "--json"});
  EXPECT_EQ(whole.code, 0) << whole.err;
  const Json result = Json::parse(whole.out);
  EXPECT_EQ(result["plan_hash"], m["campaign"]["faults"]["plan"]["plan_hash"]);
  EXPECT_EQ(result["rates"]["isolated"]["count"], m["campaign"]["faults"]["rates"]["isolated"]["count"]);
}

// Negative: REQ-254
TEST(VerifyOfAField, ARateAndWhatAFieldDoesNotShowAreRefused) {
  Directory where;
  std::filesystem::copy_file(kExamples + "six_axis.toml", where / "tool.toml");
  const Outcome rate = verify(where, {"--array", "tool.toml#gyros", "--out", "r"});
  EXPECT_EQ(rate.code, 2);
  EXPECT_TRUE(says(rate.err, {"does not serve a group of gyros", "no length to judge by",
                              "plumb geometry 'tool.toml#gyros'", "plumb monitor --group gyros", "plumb_rates_step"}));
  const Outcome known = verify(where, {"--array", "tool.toml#mag", "--known-attitude", "1:30,40", "--out", "r"});
  EXPECT_EQ(known.code, 2);
  EXPECT_TRUE(says(known.err, {"--known-attitude", "azimuth", "--align-by"}));
  write_text(where / "limits.toml", "[limits]\nfault = \"5 mg0\"\n");
  const Outcome unit = verify(where, {"--array", "tool.toml#mag", "--limits", "limits.toml", "--out", "r"});
  EXPECT_EQ(unit.code, 3);
  EXPECT_TRUE(says(unit.err, {"limits.toml:2", "mg0", "nT"}));
}

// Verifies: REQ-254
// What the accelerometers are to magnetometers: the frame and the wiring, by the dip between the two.
TEST(VerifyOfAField, AGroupThatIsAlignedToTheAccelerometersIsFit) {
  Directory where;
  for (const char* const name : {"six_axis.toml", "six_axis_stand.toml"})
    std::filesystem::copy_file(kExamples + name, where / name);
  const auto done = [&where](std::vector<std::string> arguments) {
    const Outcome outcome = run(where, std::move(arguments));
    ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  };
  done({"simulate", "six_axis_stand.toml", "--out", "stand.csv"});
  done({"calibrate", "--array", "six_axis.toml", "--log", "stand.csv", "--out", "acc.json"});
  done({"calibrate", "--array", "six_axis.toml#mag", "--log", "stand.csv", "--out", "alone.json"});
  done({"calibrate", "--array", "six_axis.toml#mag", "--log", "stand.csv", "--align-by", "acc.json", "--out",
        "mag.json"});
  const Outcome alone =
      verify(where, {"--array", "six_axis.toml#mag", "--calibration", "alone.json", "--out", "alone"}, "100");
  EXPECT_TRUE(says(alone.out + alone.err, {"INCONCLUSIVE", "the wiring is not confirmed", "--align-by"}));
  const Outcome aligned =
      verify(where, {"--array", "six_axis.toml#mag", "--calibration", "mag.json", "--out", "aligned"}, "100");
  EXPECT_TRUE(says(aligned.out, {"fit, evidence incomplete", "confirmed by the accelerometers"})) << aligned.err;
  const Json report = report_in(where / "aligned");
  EXPECT_EQ(report["calibration"]["wiring"]["status"], "confirmed");
  EXPECT_TRUE(report["calibration"]["wiring"].contains("unseen_by_field"));
  EXPECT_EQ(report["array"]["name"], "six-axis tool mag");
}

}  // namespace
}  // namespace verify_field_test
