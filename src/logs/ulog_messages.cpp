#include "ulog_messages.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr std::array<unsigned char, 8> kUlogSync = {0x2F, 0x73, 0x13, 0x20, 0x25, 0x0C, 0xBB, 0x12};

struct TypeSizes {
  unsigned char type;
  std::size_t least;
  std::size_t most;
};
constexpr std::size_t kAnySize = 65535;
constexpr std::array<TypeSizes, 13> kUlogMessageTypes = {{{'B', 40, kAnySize},
                                                          {'F', 3, kAnySize},
                                                          {'I', 2, kAnySize},
                                                          {'M', 3, kAnySize},
                                                          {'P', 2, kAnySize},
                                                          {'Q', 3, kAnySize},
                                                          {'A', 4, kAnySize},
                                                          {'R', 2, 2},
                                                          {'D', 2, kAnySize},
                                                          {'L', 9, kAnySize},
                                                          {'C', 11, kAnySize},
                                                          {'S', 8, 8},
                                                          {'O', 2, 2}}};

std::string_view message_text(const unsigned char* bytes, std::size_t count) {
  return {reinterpret_cast<const char*>(bytes), count};
}

std::string quoted_name(std::string_view name) {
  return "\"" + io::printable_line(name.substr(0, io::UlogFormats::kLongestName)) + "\"";
}

}  // namespace

UlogMessages::Judgement UlogMessages::judge(const UlogMessage& message, std::size_t available) const {
  const auto* const found = std::find_if(kUlogMessageTypes.begin(), kUlogMessageTypes.end(),
                                         [&](const TypeSizes& sizes) { return sizes.type == message.type; });
  if (found == kUlogMessageTypes.end()) return Judgement::unknown_type;
  if (message.size < found->least || message.size > found->most) return Judgement::size;
  if (message.type == 'S') {
    const std::size_t count = std::min(available, kUlogSync.size());
    return std::equal(message.payload, message.payload + count, kUlogSync.begin()) ? Judgement::good : Judgement::sync;
  }
  if (message.type != 'D' || available < 2) return Judgement::good;
  const auto known = subscriptions_.find(io::ulog_unsigned(message.payload, 2));
  if (known == subscriptions_.end()) return Judgement::unknown_id;
  const std::size_t data = message.size - 2;
  if (data < known->second.least || data > known->second.most) return Judgement::data_size;
  return known->second.removed ? Judgement::removed_id : Judgement::good;
}

void UlogMessages::note(UlogTrouble trouble, std::uint64_t offset, const std::string& what) {
  if (notes_.wanted(trouble, offset)) notes_.say(offset, what);
}

void UlogMessages::say(const UlogMessage& message, Judgement judgement, std::uint64_t end,
                       const std::string& consequence) {
  const std::string size = std::to_string(message.size);
  UlogTrouble trouble = UlogTrouble::message;
  std::string what;
  switch (judgement) {
    case Judgement::good: what = "a message of " + size + " bytes runs past byte " + std::to_string(end); break;
    case Judgement::unknown_type:
      what = "a message of the unknown type " + std::to_string(static_cast<int>(message.type));
      break;
    case Judgement::size:
      what = std::string("a message of type '") + static_cast<char>(message.type) + "' cannot have " + size + " bytes";
      break;
    case Judgement::sync: what = "a sync message without its magic bytes"; break;
    case Judgement::unknown_id:
    case Judgement::removed_id:
      trouble = UlogTrouble::unknown_id;
      what = "data of message number " + std::to_string(io::ulog_unsigned(message.payload, 2)) +
             (judgement == Judgement::unknown_id ? ", which has no subscription" : ", whose subscription was removed");
      break;
    case Judgement::data_size:
      trouble = UlogTrouble::data_size;
      what = "data of message number " + std::to_string(io::ulog_unsigned(message.payload, 2)) + " in " + size +
             " bytes, which is not what its format says";
      break;
  }
  note(trouble, message.offset, what + "; " + consequence);
}

void UlogMessages::take(const UlogMessage& message) {
  switch (message.type) {
    case 'F': take_format(message); break;
    case 'P': take_parameter(message); break;
    case 'A': take_subscription(message); break;
    case 'R': take_removal(message); break;
    case 'D': take_data(message); break;
    case 'O': dropped_ms_ += io::ulog_unsigned(message.payload, 2); break;
    case 'B':  // the first one is read with the header
      note(UlogTrouble::flags, message.offset, "flag bits that do not come first are left out");
      break;
    default: break;  // texts, default parameters, sync: nothing for whom reads accelerometers
  }
}

void UlogMessages::take_format(const UlogMessage& message) {
  const std::string wrong = formats_.define(message_text(message.payload, message.size));
  if (!wrong.empty()) note(UlogTrouble::format, message.offset, wrong);
}

void UlogMessages::take_parameter(const UlogMessage& message) {
  const std::size_t length = message.payload[0];
  if (length + 1 > message.size) {
    note(UlogTrouble::parameter, message.offset, "a parameter whose name runs past its message is left out");
    return;
  }
  io::UlogKey key;
  const std::uint32_t wanted = io::ulog_key(message_text(message.payload, message.size), key) && key.field.count == 1
                                   ? io::ulog_size(key.field.type)
                                   : 0;
  if (wanted == 0 || key.value.size() != wanted) {
    note(UlogTrouble::parameter, message.offset,
         "the parameter " + quoted_name(message_text(message.payload + 1, length)) + " has no number, left out");
    return;
  }
  sink_.parameter(key.field.name, io::ulog_number(message.payload + 1 + length, {key.field.type, 0}));
}

UlogMessages::Subscription UlogMessages::subscribe(const UlogMessage& message, const std::string& name) {
  Subscription out;
  out.name = name;
  out.instance = message.payload[0];
  const auto layout = formats_.layout(name);
  if (!layout) {
    note(UlogTrouble::subscription, message.offset,
         "the data of " + quoted_name(name) + " cannot be read: " + layout.error());
    return out;
  }
  out.least = layout->unpadded;
  out.most = layout->size;
  if (name == kUlogStatusTopic) out.status = ulog_status(*layout);
  const std::size_t topic = ulog_topic(name);
  if (topic == kNoUlogTopic) return out;
  const auto readings = ulog_readings(topic, *layout);
  if (readings) {
    out.topic = topic;
    out.readings.push_back(*readings);
    for (std::uint32_t which = 1; which < ulog_chips(topic, *layout); ++which) {
      if (const auto next = ulog_readings(topic, *layout, which)) out.readings.push_back(*next);
    }
  } else if (lacking_.insert(topic).second) {
    note(UlogTrouble::lacking, message.offset,
         name + " has no " + readings.error() + " that could be read, its data are left out");
  }
  return out;
}

void UlogMessages::take_subscription(const UlogMessage& message) {
  const std::uint64_t id = io::ulog_unsigned(message.payload + 1, 2);
  const std::string name(message_text(message.payload + 3, message.size - 3));
  if (name.size() > io::UlogFormats::kLongestName) {
    note(UlogTrouble::subscription, message.offset, "a subscription with a name of more than 255 characters, left out");
    return;
  }
  const auto known = subscriptions_.find(id);
  const bool taken = known != subscriptions_.end() && !known->second.removed;
  if (taken) {
    if (known->second.name == name && known->second.instance == message.payload[0]) return;
    note(UlogTrouble::subscription, message.offset,
         "message number " + std::to_string(id) + " is " + quoted_name(known->second.name) + " already, " +
             quoted_name(name) + " is left out");
    return;
  }
  if (known == subscriptions_.end() && subscriptions_.size() == kMostSubscriptions) {
    note(UlogTrouble::subscription, message.offset,
         "more than 4096 subscriptions, " + quoted_name(name) + " is left out");
    return;
  }
  subscriptions_[id] = subscribe(message, name);
}

void UlogMessages::take_removal(const UlogMessage& message) {
  const auto known = subscriptions_.find(io::ulog_unsigned(message.payload, 2));
  if (known != subscriptions_.end()) {
    known->second.removed = true;
    return;
  }
  note(UlogTrouble::subscription, message.offset, "a subscription is removed that there is none of");
}

void UlogMessages::take_data(const UlogMessage& message) {
  const auto known = subscriptions_.find(io::ulog_unsigned(message.payload, 2));
  if (known == subscriptions_.end()) return;
  const Subscription& data = known->second;
  if (data.status.time) sources_.add_status(data.status, message.payload + 2);
  int instance = data.instance;
  for (const UlogReadings& readings : data.readings)
    sources_.add(message.offset, data.topic, instance++, readings, message.payload + 2);
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
