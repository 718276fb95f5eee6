#include "results/reel.hpp"

#include "core/error.hpp"

#include <cstdio>
#include <fstream>
#include <utility>

namespace elamin {

Reel::Reel(std::string file, const std::string& header, std::string footer)
    : file_(std::move(file)), header_(header), footer_(std::move(footer)), end_(header.size()), out_(file_) {
  out_.add(header_ + footer_);
}

Reel::Reel(std::string file, const std::string& header, std::string footer, Archive& archive, bool dropping)
    : file_(std::move(file)), header_(header), footer_(std::move(footer)), out_(file_, GrowingFile::all) {
  carry(archive);
  dropped_ = dropping && out_.size() != end_ + footer_.size();
  if (!dropped_ && out_.size() < end_) throw InputError(file_ + ": is not as the run has left it");
  if (!dropped_) out_.replace(end_, footer_);
}

void Reel::add(std::int64_t step, const std::string& text) {
  try {
    out_.replace(end_, text + footer_);
  } catch (const OutputError&) {
    out_.replace(end_, footer_);
    throw;
  }
  frames_.push_back({step, text.size()}), end_ += text.size();
}

void Reel::drop(const std::set<std::int64_t>& steps) {
  if (!steps.empty()) drop(steps, [](const std::string& text) { return text; });
}

void Reel::drop(const std::set<std::int64_t>& steps, const std::function<std::string(const std::string&)>& changed) {
  if (std::exchange(dropped_, false)) {
    std::erase_if(frames_, [&](const Frame& f) { return steps.count(f.step) > 0; });
    end_ = out_.size() - footer_.size();
    return;
  }
  const std::string file = file_ + ".new";
  std::ifstream in(file_, std::ios::binary);
  GrowingFile out(file);
  out.add(header_);
  in.seekg(static_cast<std::streamoff>(header_.size()));
  std::vector<Frame> left;
  std::string text;
  for (const Frame& f : frames_) {
    text.resize(f.bytes);
    in.read(text.data(), static_cast<std::streamsize>(f.bytes));
    if (steps.count(f.step)) continue;
    const std::string now = changed(text);
    out.add(now);
    left.push_back({f.step, now.size()});
  }
  end_ = out.size();
  out.add(footer_);
  if (std::rename(file.c_str(), file_.c_str()) != 0) cannot_write(file_);
  out_ = std::move(out);                                       // which goes on writing there
  frames_ = std::move(left);
}

}  // namespace elamin
