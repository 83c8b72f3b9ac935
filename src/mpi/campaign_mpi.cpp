// plumb-campaign-mpi: `plumb campaign` over the ranks of an MPI job. Every rank plays its part of each batch; counts
// are united behind it, so that the result is that of one process, byte for byte, and a lost rank costs one batch.
#include <mpi.h>

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include "../command/campaign.hpp"
#include "../command/output.hpp"

namespace {

using plumb::campaign::kKept;
using plumb::campaign::Tally;

constexpr const char* kAbout =
    "plumb campaign, spread over the ranks of an MPI job:\n"
    "  mpirun -n 4 plumb-campaign-mpi examples/guaranteed.toml --out result.json --resume\n"
    "Options and result are those of plumb campaign. If a rank is lost, MPI ends the job; --resume continues from the\n"
    "last result that was written, with any number of ranks.";

class MpiRanks final : public plumb::campaign::Ranks {
 public:
  MpiRanks() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  int rank() const noexcept override { return rank_; }
  int size() const noexcept override { return size_; }

  void unite(Tally::Numbers& numbers) override {
    reduce(numbers.sums, MPI_SUM);
    reduce(numbers.maxima, MPI_MAX);
    const int count = static_cast<int>(numbers.firsts.size());
    std::vector<std::uint64_t> all(numbers.firsts.size() * static_cast<std::size_t>(size_));
    MPI_Allgather(numbers.firsts.data(), count, MPI_UINT64_T, all.data(), count, MPI_UINT64_T, MPI_COMM_WORLD);
    // Lists of kKept numbers, one behind the other in every rank: of each the smallest over all ranks.
    const auto stride = numbers.firsts.size();
    for (std::size_t list = 0; list + kKept <= stride; list += kKept) {
      std::vector<std::uint64_t> found;
      for (std::size_t from = list; from < all.size(); from += stride) {
        found.insert(found.end(), all.begin() + static_cast<std::ptrdiff_t>(from),
                     all.begin() + static_cast<std::ptrdiff_t>(from + kKept));
      }
      std::partial_sort(found.begin(), found.begin() + kKept, found.end());
      std::copy_n(found.begin(), kKept, numbers.firsts.begin() + static_cast<std::ptrdiff_t>(list));
    }
  }

  bool any(bool mine) override {
    int one = mine ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &one, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return one != 0;
  }

 private:
  static void reduce(std::vector<std::uint64_t>& numbers, MPI_Op how) {
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_UINT64_T, how, MPI_COMM_WORLD);
  }
  int rank_ = 0, size_ = 1;
};

int run(int argc, char** argv) {
  MpiRanks ranks;
  const plumb::command::CommandLine line(kAbout, "plumb-campaign-mpi", std::string("plumb ") + PLUMB_VERSION);
  plumb::command::CampaignOptions options;
  plumb::command::add_campaign_options(line.options(), options);
  const plumb::command::Reading reading = line.read(argc, argv);
  if (reading.end == plumb::command::Reading::End::answered) {
    if (ranks.rank() == 0) plumb::command::print(reading.text);
    return 0;
  }
  if (reading.end == plumb::command::Reading::End::refused) {
    if (ranks.rank() == 0) {
      plumb::command::print_error("plumb: " + reading.text + ".\nTry: plumb-campaign-mpi --help\n");
    }
    return plumb::io::to_int(plumb::io::ExitCode::usage);
  }
  const plumb::io::ExitCode code = plumb::command::run_campaign(options, ranks);
  return plumb::command::output_is_sound() ? plumb::io::to_int(code) : plumb::io::to_int(plumb::io::ExitCode::other);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int code = plumb::io::to_int(plumb::io::ExitCode::other);
  try {
    code = run(argc, argv);
  } catch (const std::exception& error) {
    plumb::command::print_error(std::string("plumb: unexpected: ") + error.what() + ". Please report this.\n");
    MPI_Abort(MPI_COMM_WORLD, code);
  }
  // mpirun reports the code of one rank or another; all say the same.
  MPI_Bcast(&code, 1, MPI_INT, 0, MPI_COMM_WORLD);
  MPI_Finalize();
  return code;
}
