#pragma once
// A reference configuration of data/lammps as a problem file.
#include "reference.hpp"
#include "study/program.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <vector>

/// The parameters, the answer and the place of one case.
struct LammpsCase {
  explicit LammpsCase(const std::string& name)
      : directory(std::string(ELAMIN_ROOT) + "/data/lammps/" + name),
        parameters(reference("lammps/" + name + "/case.json")),
        expected(reference("lammps/" + name + "/expected.json")) {}

  /// What case.json says as a problem file: particles of `data` (default: its own), contacts, walls, loads and clamps.
  std::string problem(const std::string& study, const std::string& data = "") const;

  std::string directory;
  nlohmann::json parameters, expected;
};

/// Rows [id, x, y, z, …] as 3 × rows.
inline Eigen::MatrixXd matrix(const nlohmann::json& rows) {
  Eigen::MatrixXd m(3, rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (int c = 0; c < 3; ++c) m(c, i) = rows[i][1 + c];
  return m;
}

/// id,fx,fy,fz of a file as 3 × rows.
inline Eigen::MatrixXd forces_of(const std::string& file) {
  const auto rows = csv_rows(file);
  Eigen::MatrixXd m(3, rows.size() - 1);
  for (std::size_t i = 1; i < rows.size(); ++i)
    for (int c = 0; c < 3; ++c) m(c, i - 1) = std::stod(rows[i][1 + c]);
  return m;
}
