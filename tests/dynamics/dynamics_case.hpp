#pragma once
// A moving configuration of data/lammps as a model.
#include "dynamics/contact_damping.hpp"
#include "input/model_of.hpp"
#include "matrices.hpp"
#include "study/lammps_case.hpp"

namespace elamin {

/// The model that case.json describes; what it says of damping is put on contacts and walls here.
inline Model model_of_case(const LammpsCase& c) {
  Model model = model_of(c.problem("dynamics"));
  const auto damping = [](const nlohmann::json& table) {
    using Way = ContactDamping::Model;
    ContactDamping d;
    if (!table.contains("damping")) return d;
    const nlohmann::json& given = table["damping"];
    const std::map<std::string, Way> ways{{"velocity", Way::velocity}, {"mass_velocity", Way::mass_velocity},
                                          {"viscoelastic", Way::viscoelastic}, {"tsuji", Way::tsuji}};
    d.model = ways.at(given["model"]), d.coefficient = given["coefficient"];
    if (d.model == Way::tsuji) d.coefficient = tsuji_coefficient(d.coefficient);
    d.tangential = given["tangential"], d.friction = given["friction"];
    return d;
  };
  for (std::size_t k = 0; k < model.contacts.size(); ++k) model.contacts[k].damping = damping(c.parameters["granular"]["pairs"].at(0));
  for (std::size_t k = 0; k < model.walls.size(); ++k) model.walls[k].damping = damping(c.parameters["walls"].at(k));
  return model;
}

/// Rows [id, x, y, z, …] as 3 × rows, by id.
inline Field field_of(const nlohmann::json& rows) {
  Field f(3, rows.size());
  for (const auto& row : rows)
    for (int c = 0; c < 3; ++c) f(c, row[0].get<int>() - 1) = row[1 + c];
  return f;
}

}  // namespace elamin
