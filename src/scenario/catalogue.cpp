#include "plumb/scenario/catalogue.hpp"

#include <array>
#include <utility>

#include "fault_parts.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

/// How much later a later part begins, by `Clock`.
constexpr std::array<double, 3> kLater = {20.0, 2000.0, 6.0};

/// "bias=50mg0" with another size.
std::string resized(const std::string& body, const std::string& size) {
  return size.empty() ? body : body.substr(0, body.find('=')) + "=" + size;
}

std::string with_neighbour(std::string body, const std::string& neighbour) {
  const std::size_t at = body.find("$1");
  if (at != std::string::npos) body.replace(at, 2, neighbour);
  return body;
}

}  // namespace

const std::vector<Px4Alias>& px4_aliases() {
  static const std::vector<Px4Alias> aliases = {{"off", "F12", "missing"},
                                                {"stuck", "F02", "last"},
                                                {"garbage", "F03", "random=-1g0..1g0"},
                                                {"wrong", "F04", "bias=50mg0"},
                                                {"slow", "F12", "slow=10"},
                                                {"delayed", "F12", "late=20"},
                                                {"intermittent", "F12", "missing=50%"}};
  return aliases;
}

std::optional<CatalogueEntry> find_entry(std::string_view word) {
  const auto entry_of = [](std::string_view key) -> std::optional<CatalogueEntry> {
    for (const CatalogueEntry& entry : catalogue()) {
      if (key == entry.id || key == entry.name) return entry;
    }
    return std::nullopt;
  };
  if (auto entry = entry_of(word)) return entry;
  for (const Px4Alias& alias : px4_aliases()) {
    if (word != alias.word) continue;
    auto entry = entry_of(alias.id);
    if (entry) entry->parts = {{alias.body}};
    return entry;
  }
  return std::nullopt;
}

tl::expected<std::vector<Fault>, std::string> faults_of(const CatalogueEntry& entry, const CatalogueOptions& options,
                                                        const FaultContext& context) {
  const int n = context.datasheet.size;
  if (options.sensor < 0 || options.sensor >= n) {
    return tl::unexpected<std::string>("the array has no such sensor. Remedy: name one of the array");
  }
  const int next = (options.sensor + 1) % n;
  std::vector<Fault> faults;
  std::string size = options.size;
  for (const CataloguePart& part : entry.parts) {
    const std::string body = with_neighbour(resized(part.body, size), id_of(context, next));
    size.clear();
    const bool every = part.victim == Victim::every;
    for (int i = 0; i < (every ? n : 1); ++i) {
      std::string who = "log";
      if (every) who = id_of(context, i);
      if (part.victim == Victim::named) who = id_of(context, options.sensor);
      if (part.victim == Victim::next) who = id_of(context, next);
      auto fault = parse_fault(who + ":" + body + "@0s", context);
      if (!fault) return tl::unexpected<std::string>(fault.error());
      fault->clock = options.clock;
      fault->onset = options.onset + (part.later ? kLater[static_cast<std::size_t>(options.clock)] : 0.0);
      fault->duration = options.duration;
      const auto checked = check(*fault, n);
      if (!checked) return tl::unexpected<std::string>(checked.error());
      faults.push_back(*fault);
    }
  }
  return faults;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
