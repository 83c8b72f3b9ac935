// The one table: a row per family, and per number of sensors where it matters.
#pragma once

#include <string>

#include "plumb/io/file_error.hpp"
#include "progress.hpp"

namespace plumb_bench {

/// Promises broken: safety columns of promised families, and failed where a family promises that it does not. One line
/// each, empty where all hold.
std::string broken_promises(const Progress& progress);

/// As Markdown, with Clopper-Pearson bounds, 95 % and for a count of 0 or all 97.5 %, rounded outwards; `every_n` gives
/// each number of sensors its row in every family.
std::string table_text(const Progress& progress, bool every_n);
/// The same rows and figures as JSON.
std::string table_json(const Progress& progress);
/// "before -> now" in every column, as Markdown; `before` is the path of a file with what `table_json` wrote elsewhere.
plumb::io::FileExpected<std::string> comparison_text(const std::string& before, const Progress& progress);

}  // namespace plumb_bench
