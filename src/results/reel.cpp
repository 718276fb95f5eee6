#include "results/reel.hpp"

#include "core/error.hpp"
#include "results/table.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace elamin {

Reel::Reel(std::string file, const std::string& header, std::string footer)
    : file_(std::move(file)), header_(header), footer_(std::move(footer)), end_(header.size()), out_(file_, std::ios::binary) {
  out_ << header_ << footer_ << std::flush;
  check();
}

Reel::Reel(std::string file, const std::string& header, std::string footer, Archive& archive, bool dropping)
    : file_(std::move(file)), header_(header), footer_(std::move(footer)) {
  carry(archive);
  std::error_code error;
  dropped_ = dropping && std::filesystem::file_size(file_, error) != end_ + footer_.size();
  if (!dropped_) cut(file_, end_);
  out_.open(file_, std::ios::binary | std::ios::in | std::ios::out);
  out_.seekp(0, std::ios::end);
  if (!dropped_) out_ << footer_ << std::flush;
  check();
}

void Reel::check() const {
  if (!out_) throw InputError(file_ + ": cannot be written: " + std::strerror(errno));
}

void Reel::add(std::int64_t step, const std::string& text) {
  out_.seekp(static_cast<std::streamoff>(end_));
  out_ << text << footer_ << std::flush;
  check();
  frames_.push_back({step, text.size()}), end_ += text.size();
}

void Reel::drop(const std::set<std::int64_t>& steps) {
  if (!steps.empty()) drop(steps, [](const std::string& text) { return text; });
}

void Reel::drop(const std::set<std::int64_t>& steps, const std::function<std::string(const std::string&)>& changed) {
  if (std::exchange(dropped_, false)) {
    std::erase_if(frames_, [&](const Frame& f) { return steps.count(f.step) > 0; });
    end_ = std::filesystem::file_size(file_) - footer_.size();
    return;
  }
  const std::string file = file_ + ".new";
  std::ifstream in(file_, std::ios::binary);
  out_.close(), out_.open(file, std::ios::binary);
  out_ << header_;
  in.seekg(static_cast<std::streamoff>(header_.size()));
  end_ = header_.size();
  std::vector<Frame> left;
  std::string text;
  for (const Frame& f : frames_) {
    text.resize(f.bytes);
    in.read(text.data(), static_cast<std::streamsize>(f.bytes));
    if (steps.count(f.step)) continue;
    const std::string now = changed(text);
    out_ << now;
    left.push_back({f.step, now.size()}), end_ += now.size();
  }
  out_ << footer_ << std::flush;
  check();
  std::filesystem::rename(file, file_);                      // out_ goes on writing there
  frames_ = std::move(left);
}

}  // namespace elamin
