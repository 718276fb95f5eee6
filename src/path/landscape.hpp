#pragma once
// Equilibria at given load factors: minima, saddles, which minima a saddle joins, and what becomes of them from one load factor to the next.
#include "path/equilibrium.hpp"
#include "path/landscape_options.hpp"

#include <array>

namespace elamin {

/// An equilibrium, and those that are its images by a symmetry of the structure.
struct LandscapeNode {
  std::string label;                   // minimum:1, saddle:1, of index 2 and more stationary:1; at the next load factor the same
  std::vector<Equilibrium> images;     // not empty
  Vector spectrum;                     // its lowest eigenvalues, without zero modes
  Vector distances;                    // Σⱼ |xᵢ − xⱼ| of all particles and bodies i, ascending
  int expanded = 0;                    // images that walks have been made from
  int index() const { return images.front().point.stability.negative; }
  double energy() const { return images.front().point.energy.total(); }
};

/// An image of a node; node −1: none.
struct NodeImage {
  int node = -1, image = 0;
  bool operator==(const NodeImage&) const = default;
};

/// What a saddle joins: the minima that its two sides lead down to.
struct Pass {
  NodeImage saddle;
  std::array<NodeImage, 2> minima;
};

struct Landscape {
  double load_factor = 0;
  std::vector<LandscapeNode> nodes;
  std::vector<Pass> passes;            // of every image of every saddle
  const LandscapeNode& node(const NodeImage& i) const { return nodes[i.node]; }
  const Equilibrium& at(const NodeImage& i) const { return node(i).images[i.image]; }
  /// All images of the nodes with this index; −1: of all nodes.
  std::vector<NodeImage> images(int index) const;
  int minima() const { return static_cast<int>(images(0).size()); }
  int saddles() const { return static_cast<int>(images(1).size()); }
  /// Σ (−1)^index over all images: 1 where all equilibria are known of an energy that grows beyond bounds everywhere (Morse 1934).
  int euler() const;
  /// The energy from the image up to the lowest saddle that joins it to another minimum; infinity: none is known.
  double barrier(const NodeImage& minimum) const;
};

/// What happens to nodes between two load factors.
struct LandscapeChange {
  double load_factor = 0;
  std::vector<std::string> nodes;
  std::string what;                    // a sentence
  std::string event;                   // that explains it, a label of the path; "": none does
};

/// An event of a path.
struct PathEvent {
  std::string label;
  double load_factor = 0;
};

struct Landscapes {
  std::vector<Landscape> at;
  std::vector<LandscapeChange> changes;
  std::vector<std::string> notes;      // what was not found
};

/// The landscapes at load factors in their order. known: equilibria (or states near them) to begin with, at any of these load factors;
/// events: of the path that they are of.
///
/// From every minimum walks lead up along its soft modes, both ways; from every saddle of index 1 down both sides; from one of higher index down
/// along each of its negative directions, up along another one; besides down from random starts, to what deflation finds, and over lines
/// between minima that no saddle joins.
///
/// Two equilibria are one if they are at one place. They are images of each other if their index, energy, lowest eigenvalues and distances
/// agree: sums of distances are the same of what rotates or reflects a structure as a whole and changes equal particles with each other. Images by
/// reflections in the planes, half turns about the axes of coordinates through the middle, and the inversion in it are made, kept if they are
/// equilibria of the same energy, and so found without a walk.
///
/// A node is followed to the next load factor by steps along its tangent, and a node that is new there back to the one before: it ends where
/// steps shrink to nothing, at a limit point, or its index changes, at a branch point or a contact.
[[nodiscard]] Landscapes explore(Newton& newton, const std::vector<State>& known, const std::vector<PathEvent>& events,
                                 const std::vector<double>& load_factors, const LandscapeOptions& options,
                                 const std::function<void(const std::string&)>& tell = {});

}  // namespace elamin
