#include "report/report.hpp"

#include "core/say.hpp"
#include "core/text.hpp"
#include "core/text_file.hpp"
#include "report/base64.hpp"
#include "report/parts.hpp"
#include "report/run_data.hpp"
#include "results/results_directory.hpp"
#include "results/stored_run.hpp"
#include "results/summary.hpp"

#include <fmt/format.h>
#include <openssl/sha.h>

#include <filesystem>
#include <map>

namespace elamin {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_bytes_of_states = 14'000'000;   // of a page; the libraries take 1.2 MB, tables and texts the rest

/// As Content-Security-Policy names what it lets run.
std::string hash_of(std::string_view text) {
  std::vector<unsigned char> digest(SHA256_DIGEST_LENGTH);
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  return fmt::format("'sha256-{}'", base64(digest));
}

/// JSON in which no '<' begins a tag or a comment.
std::string json_text(const Json& json) {
  std::string all;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') all += "\\u003c";
    else all += c;
  }
  return all;
}

/// The template with {{name}} replaced, each by its text as it is.
std::string filled(std::string_view page, const std::map<std::string, std::string, std::less<>>& texts) {
  std::string all;
  for (std::size_t at = 0;;) {
    const std::size_t open = page.find("{{", at);
    all += page.substr(at, open - at);
    if (open == page.npos) return all;
    const std::size_t close = page.find("}}", open);
    all += texts.at(std::string(page.substr(open + 2, close - open - 2)));
    at = close + 2;
  }
}

std::string quoted(const std::string& text) {
  if (text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=+,-") == text.npos) return text;
  std::string all = "'";
  for (const char c : text) all += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return all + "'";
}

std::string file_of(const ReportOptions& options) {
  if (!options.file.empty()) return options.file;
  return options.directories.size() == 1 ? (fs::path(options.directories.front()) / "report.html").string() : "report.html";
}

std::string command_of(const ReportOptions& options) {
  std::string command = "elamin report";
  for (const std::string& d : options.directories) command += fmt::format(" {}", quoted(d));
  return options.file.empty() ? command : fmt::format("{} -o {}", command, quoted(options.file));
}

Json page_data(const ReportOptions& options) {
  std::vector<std::string> directories;
  for (const std::string& d : options.directories)
    for (const std::string& run : runs_in(d)) directories.push_back(run);
  Json data;
  data["version"] = version(), data["command"] = command_of(options);
  for (const auto& [key, name] : {std::pair{"sweep", "sweep.csv"}, {"refined", "refine.csv"}}) {
    const std::string table = (fs::path(options.directories.front()) / name).string();
    data[key] = options.directories.size() == 1 && fs::exists(table) ? table_data(table) : Json(nullptr);
  }
  data["runs"] = Json::array();
  std::size_t stored = 0, kept = 0;
  for (const std::string& d : directories) {
    data["runs"].push_back(run_data(d, most_bytes_of_states / directories.size()));
    const Json& run = data["runs"].back();
    if (!run.contains("states")) continue;
    stored += run["states"]["stored"].get<std::size_t>(), kept += run["states"]["kept"].get<std::size_t>();
  }
  data["note"] = kept == stored ? fmt::format("All {} stored states are in it.", stored)
                                : fmt::format("Of {} stored states {} are in it, so that it stays small; their files have all.", stored, kept);
  return data;
}

}  // namespace

std::string report_page(const ReportOptions& options) {
  using namespace parts;
  const Json data = page_data(options);
  std::string scripts, policy = fmt::format("default-src 'none'; img-src data: blob:; base-uri 'none'; form-action 'none'; style-src {}; script-src",
                                            hash_of(style_css));
  for (const std::string_view script : {three_js, orbit_js, d3_js, data_js, diagram_js, shape_js, charts_js, page_js}) {
    policy += ' ' + hash_of(script);
    scripts += fmt::format("<script>{}</script>\n", script);
  }
  const Json& first = data["runs"].front();
  const std::string title = first["title"].get<std::string>();
  return filled(page_html, {{"policy", policy}, {"title", as_markup(title.empty() ? first["directory"].get<std::string>() : title)}, {"version", version()},
                            {"style", std::string(style_css)}, {"data", json_text(data)}, {"scripts", scripts}, {"licences", std::string(licences_txt)}});
}

void report_command(const ReportOptions& options) {
  const std::string file = file_of(options), page = report_page(options);
  write_text(file, page);
  list_also(fs::path(file).parent_path().string(), fs::path(file).filename().string());
  if (!options.quiet) say("written: {} ({:.1f} MB)\n", file, static_cast<double>(page.size()) / 1e6);
}

}  // namespace elamin
