#pragma once
// One self-contained HTML page of the results of runs.
#include <string>
#include <vector>

namespace elamin {

struct ReportOptions {
  std::vector<std::string> directories;         // of runs or sweeps
  std::string file;                             // "": report.html in the directory; of several directories in the one the program runs in
  bool quiet = false;
};

/// The page: everything that a browser needs is in it. What comes from files stands in it as JSON, in which nothing is markup;
/// scripts run only if their hash is in the page's policy. States are thinned so that a page stays under 20 MB.
/// Throws InputError if a directory holds no results.
std::string report_page(const ReportOptions& options);

/// `elamin report DIR…`: writes the page and says where.
void report_command(const ReportOptions& options);

}  // namespace elamin
