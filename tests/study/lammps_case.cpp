#include "study/lammps_case.hpp"

#include "lammps/data.hpp"

#include <algorithm>

namespace {

using CaseJson = nlohmann::json;
using Ids = std::set<int>;

std::string number(const CaseJson& v) { return fmt::format("{:.17g}", v.get<double>()); }

std::string list(const CaseJson& v) {
  std::string text;
  for (const CaseJson& x : v) text += (text.empty() ? "" : ", ") + number(x);
  return "[" + text + "]";
}

class Writer {
 public:
  Writer(const CaseJson& parameters, const elamin::LammpsData& data) : c_(parameters), data_(data) {}

  void contacts() {
    if (!c_.contains("granular")) return;
    const CaseJson& granular = c_["granular"];
    const std::string bonded = granular["bonded_pairs"];
    const std::string excluded = bonded == "none" ? "" : bonded == "included" ? "exclude_bonds = 0\n" : "exclude_bonds = 1\n";
    for (const CaseJson& pair : granular["pairs"]) {
      std::string law = "law = \"hertz\"\n" + excluded;
      if (pair["source"] == "mixed")                       // the formula for unlike materials
        law += fmt::format("youngs_modulus = [{}, {}]\npoissons_ratio = [{}, {}]\n", number(pair["E_i"]), number(pair["E_j"]), number(pair["nu_i"]), number(pair["nu_j"]));
      else
        law += "effective_modulus = " + number(pair["E_eff"]) + "\n";
      const Ids a = of_type(pair["i"]), b = of_type(pair["j"]);
      if (!granular.value("excluded_by_molecule", false)) {
        contact(a, b, law);
        continue;
      }
      for (const int m : std::set<int>(data_.molecule.begin(), data_.molecule.end())) {
        Ids within, without;
        for (const int id : a) if (molecule(id) == m) within.insert(id);
        for (const int id : b) if (molecule(id) != m) without.insert(id);
        if (!within.empty() && !without.empty()) contact(within, without, law);
      }
    }
  }

  void cohesion() {
    if (!c_.contains("lj")) return;
    for (const CaseJson& pair : c_["lj"]["pairs"])
      if (pair["epsilon"] != 0)
        contact(of_type(pair["i"]), of_type(pair["j"]), fmt::format("law = \"lj\"\nepsilon = {}\nsigma = {}\ncutoff = {}\n", number(pair["epsilon"]), number(pair["sigma"]), number(pair["cutoff"])));
  }

  void walls() {
    for (const CaseJson& w : c_.value("walls", CaseJson::array())) {
      const CaseJson& r = w["region"];
      const std::string shape = r["shape"], on = group(ids(w["atoms"]));
      text += fmt::format("[[wall]]\nname = {}\ngroup = \"{}\"\nshape = \"{}\"\nside = \"{}\"\neffective_modulus = {}\neffective_radius = \"curved\"\n",
                          w["id"].dump(), on, shape, r["side"] == "in" ? "inside" : "outside", number(w["E_eff"]));
      if (r.contains("axis")) text += "axis = " + r["axis"].dump() + "\n";
      for (const char* key : {"point", "normal", "center", "radius", "radius_lo", "radius_hi", "lo", "hi"})
        if (r.contains(key)) text += fmt::format("{} = {}\n", key, r[key].is_array() ? list(r[key]) : number(r[key]));
      if (!r.contains("open")) continue;
      const std::vector<std::string> faces = shape == "block" ? std::vector<std::string>{"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"}
                                                              : std::vector<std::string>{"lo", "hi", "side"};
      CaseJson open = CaseJson::array();
      for (const int face : r["open"].get<std::vector<int>>()) open.push_back(faces.at(face - 1));
      text += "open = " + open.dump() + "\n";
    }
  }

  void loads() {
    for (const CaseJson& l : c_.value("loads", CaseJson::array())) {
      const std::string on = group(ids(l["atoms"])), kind = l["kind"];
      if (kind == "force") text += fmt::format("[[load]]\ngroup = \"{}\"\nforce = {}\n", on, list(l["force"]));
      if (kind == "gravity") text += fmt::format("[[gravity]]\ngroup = \"{}\"\nacceleration = {}\n", on, list(l["acceleration"]));
      if (kind == "viscous") text += fmt::format("[[viscosity]]\ngroup = \"{}\"\ncoefficient = {}\n", on, number(l["gamma"]));
    }
  }

  void clamps() {
    if (c_.contains("equilibrium")) text += fmt::format("[[support]]\ngroup = \"{}\"\n", group(ids(c_["equilibrium"]["clamped"])));
  }

  void dynamics() {
    if (!c_.contains("dynamics")) return;
    const CaseJson& d = c_["dynamics"];
    for (const CaseJson& m : d.value("moved", CaseJson::array()))
      text += fmt::format("[[support]]\ngroup = \"{}\"\nvelocity = {}\n", group(ids(m["atoms"])), list(m["velocity"]));
    const std::vector<int> steps = d["record_steps"];
    text += fmt::format("[dynamics]\ntimestep = {}\nsteps = {}\nevery = {}\nrecord = {}\n", number(d["dt"]), steps.back(),
                        steps.back(), d["record_steps"].dump());
  }

  std::string text;

 private:
  int molecule(int id) const { return data_.molecule[std::lower_bound(data_.id.begin(), data_.id.end(), id) - data_.id.begin()]; }

  Ids of_type(const CaseJson& type) const {
    Ids all;
    for (std::size_t k = 0; k < data_.id.size(); ++k)
      if (type.is_string() || data_.type[k] == type.get<int>()) all.insert(data_.id[k]);
    return all;
  }

  Ids ids(const CaseJson& atoms) const { return atoms.is_string() ? of_type(atoms) : atoms.get<Ids>(); }

  /// The name of a group of these particles, which is written when it is first asked for.
  std::string group(const Ids& which) {
    if (which.size() == data_.id.size()) return "all";
    const auto [it, fresh] = groups_.emplace(which, fmt::format("g{}", groups_.size() + 1));
    if (fresh) text += fmt::format("[[group]]\nname = \"{}\"\nids = {}\n", it->second, CaseJson(which).dump());
    return it->second;
  }

  void contact(const Ids& a, const Ids& b, const std::string& law) {
    const std::string first = group(a), second = group(b);
    text += fmt::format("[[contact]]\nbetween = [\"{}\", \"{}\"]\n{}", first, second, law);
  }

  const CaseJson& c_;
  const elamin::LammpsData& data_;
  std::map<Ids, std::string> groups_;
};

}  // namespace

std::string LammpsCase::problem(const std::string& study, const std::string& data) const {
  const elamin::LammpsData particles = elamin::read_lammps_data(directory + "/case.data", "");
  Writer w(parameters, particles);
  w.text = fmt::format("[study]\ntype = \"{}\"\n[lammps]\ndata = \"{}\"\n", study, data.empty() ? directory + "/case.data" : data);
  w.contacts(), w.cohesion(), w.walls(), w.loads(), w.clamps(), w.dynamics();
  return w.text;
}
