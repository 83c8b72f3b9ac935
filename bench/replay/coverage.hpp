// What the cases of a corpus have met, each counted once a case.
#pragma once

#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace plumb_replay {

class Coverage {
 public:
  /// This case has met `what` of that group ("state", "nominal").
  void met(const std::string& group, const std::string& what) { now_.insert({group, what}); }
  void end_case();

  /// A whole corpus has to meet it.
  void want(const std::string& group, const std::string& what) { wanted_.insert({group, what}); }
  /// "group what" of what was wanted and not met.
  std::vector<std::string> missing() const;
  /// Lines that begin with #: every group with its numbers, then what is missing.
  void print(std::FILE* out) const;

 private:
  using Key = std::pair<std::string, std::string>;
  std::set<Key> now_, wanted_;
  std::map<Key, int> cases_;
};

}  // namespace plumb_replay
