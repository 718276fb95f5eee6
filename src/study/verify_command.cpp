#include "study/commands.hpp"

#include "core/error.hpp"
#include "core/say.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace elamin {

int verify_command(const std::vector<std::string>& files, const RunOptions& options) {
  int status = exit_done, met = 0, expectations = 0, wrong = 0;
  for (const std::string& file : files) {
    RunOptions one = options;
    one.file = file;
    if (files.size() > 1 && !options.directory.empty())
      one.directory = (std::filesystem::path(options.directory) / std::filesystem::path(file).stem()).string();
    try {
      const RunResult result = run(one);
      int here = 0;
      for (const Verdict& v : result.verdicts) {
        here += v.met;
        if (!v.met || !options.quiet) say("{} {}\n", v.met ? "met    " : "NOT MET", v.sentence);
      }
      const int all = static_cast<int>(result.verdicts.size());
      met += here, expectations += all;
      if (all == 0) say("{}: nothing is expected of this file: it has no [[expect]]\n", file);
      status = std::max(status, here < all ? std::max<int>(result.exit_status, exit_not_met) : result.exit_status);
      if (result.exit_status == exit_interrupted) return exit_interrupted;
    } catch (const InputError& error) {
      complain("{}\n", error.what());
      ++wrong;
    } catch (const OutputError& error) {
      complain("{}\n", error.what());
      status = std::max<int>(status, exit_not_converged);
    }
  }
  if (wrong < static_cast<int>(files.size()))
    say("{} of {} expectations met in {} file{}\n", met, expectations, files.size(), files.size() == 1 ? "" : "s");
  return wrong > 0 ? exit_wrong_input : status;
}

}  // namespace elamin
