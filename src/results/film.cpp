#include "results/film.hpp"

#include "core/error.hpp"
#include "core/interrupt.hpp"
#include "lammps/state.hpp"

#include <fmt/format.h>

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

bool Reel::drop(const std::set<std::int64_t>& steps, const std::function<std::optional<std::string>(const std::string&)>& changed) {
  if (std::exchange(dropped_, false)) {
    std::erase_if(frames_, [&](const Frame& f) { return steps.count(f.step) > 0; });
    end_ = out_.size() - footer_.size();
    return true;
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
    const std::optional<std::string> now = changed(text);
    if (!now) return std::remove(file.c_str()), false;
    out.add(*now);
    left.push_back({f.step, now->size()});
  }
  end_ = out.size();
  out.add(footer_);
  if (std::rename(file.c_str(), file_.c_str()) != 0) cannot_write(file_);
  out_ = std::move(out);                                       // which goes on writing there
  frames_ = std::move(left);
  return true;
}

namespace {

const char* header(const std::string& end) {
  return end == ".pvd" ? "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n" : "";
}
const char* footer(const std::string& end) { return end == ".pvd" ? "</Collection>\n</VTKFile>\n" : ""; }

}  // namespace

Film::Film(ResultsDirectory& directory, std::string name, const std::vector<std::string>& words, std::string title)
    : directory_(directory), name_(std::move(name)), title_(std::move(title)), words_(words.begin(), words.end()) {}

Reel& Film::reel(const std::string& end) {
  const auto found = reels_.find(end);
  return found != reels_.end() ? found->second : reels_.try_emplace(end, directory_.file(name_ + end), header(end), footer(end)).first->second;
}

void Film::carry(Archive& archive, bool dropping) {
  std::vector<std::string> ends;
  for (const auto& [end, reel] : reels_) ends.push_back(end);
  archive(boxes_, ends);
  for (const std::string& end : ends)
    if (archive.reads()) reels_.try_emplace(end, directory_.file(name_ + end), header(end), footer(end), archive, dropping);
    else archive(reels_.at(end));
}

void Film::add_dump(const std::string& end, const Shot& shot, bool of_bodies) {
  const Box box = dump_box(shot.model, shot.state, of_bodies);
  Box& all = boxes_.try_emplace(end, box).first->second;
  all.lo = all.lo.cwiseMin(box.lo), all.hi = all.hi.cwiseMax(box.hi);
  reel(end).add(shot.step, dump_frame(shot.step, shot.model, shot.state, columns_of(shot), of_bodies, all));
}

void Film::add(const Shot& shot) {
  const Model& model = shot.model;
  const bool particles = model.particles() > 0, bodies = !model.bodies.empty();
  if (words_.count("lammpstrj")) {
    if (particles && !reels_.count(".lammpstrj")) write_topology(directory_.file(directory_.free_name(name_) + ".data"), model, shot.state, title_);
    if (particles) add_dump(".lammpstrj", shot, false);
    if (bodies) add_dump(particles ? ".bodies.lammpstrj" : ".lammpstrj", shot, true);
  }
  if (words_.count("xyz")) reel(".xyz").add(shot.step, xyz_frame(shot));
  if (words_.count("pvd")) {
    const std::string file = fmt::format("frames/{}.vtu", shot.step);
    write_vtu(directory_.file(file), shot);
    const std::string line = shot.motion ? fmt::format("{}", shot.parameter) : fmt::format("{}", shot.step);
    reel(".pvd").add(shot.step, fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>\n", line, file));
  }
}

void Film::drop(const std::set<std::int64_t>& steps) {
  for (auto& [end, reel] : reels_) reel.drop(steps);
}

bool Film::finish(const std::set<std::int64_t>& dropped) {
  for (auto& [end, reel] : reels_) {
    const auto box = boxes_.find(end);
    if (box == boxes_.end() && dropped.empty()) continue;
    const bool whole = reel.drop(dropped, [&](const std::string& frame) -> std::optional<std::string> {
      if (interrupted()) return {};
      return box == boxes_.end() ? frame : in_box(frame, box->second);
    });
    if (!whole) return false;
  }
  return true;
}

}  // namespace elamin
