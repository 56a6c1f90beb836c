#pragma once

#include "Device/Buffer.h"
#include "Device/ExactValues.h"
#include "Device/Monitor.h"
#include "Distribution/HeldFailure.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "LatticeBoltzmann/Steady/JoinedLine.h"
#include "LatticeBoltzmann/Steady/PiecesOfLines.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Light that moves along lines of links between collisions (numerics.md, Eqs. (L7) to (L10)). Each line is solved
/// directly, up and down. A line that blocks cut is solved in pieces: each rank follows its own up, the rank at which a
/// line begins joins its pieces, and each rank follows its own down; the sums are those of one rank, to rounding.
class LinesOfLinks
{
public:
  using Values = std::vector<double>;

  /// Collective. All must outlive it.
  /// @param lattice  of the block, whose densities are written; null where the block has no voxels
  LinesOfLinks(Device& device, const LatticeProblem& problem, const LatticeSettings& settings,
    const LatticeVoxels& voxels, const Lattice* lattice);

  /// Collective.
  /// @param even    W / length^2 that collisions and sources send evenly, by own voxel
  /// @param incident  1, or 0: no incident light
  /// @param writes  densities are written, those beyond the block's faces too
  /// @return what arrives in each own voxel, W / length^2
  Values Sweep(const Values& even, double incident, bool writes, const Monitor& monitor);

private:
  /// Pieces about which this rank and another exchange numbers, in an order that both know.
  struct Shared
  {
    int rank = 0;
    std::vector<std::size_t> pieces;
  };
  /// A line that this rank joins: the place of each of its pieces among all that this rank receives.
  struct Line
  {
    std::vector<std::size_t> places;
    bool closed = false;
  };
  struct Pair
  {
    std::array<std::size_t, 2> range = {}; ///< of work-items
    std::vector<Shared> sentTo;            ///< this rank's pieces, by the rank that joins their lines
    std::vector<Shared> receivedFrom;      ///< pieces of the lines that this rank joins, by the rank that has them
    std::vector<Line> lines;
    std::vector<PieceOfLine> parts; ///< of the pieces received, side by side
    ExactValues below;
  };
  /// A range of each piece's numbers.
  struct Part
  {
    std::size_t first = 0, count = 0, of = 0;
  };
  struct Slot ///< scratch of a pair in progress, as LatticeLines.cl and CutLines.cl have it
  {
    ExactValues behind, share, sent, joined;
  };

  void Load();
  void LoadCutLines();
  Pair LinesFrom(const PiecesOfLines& pieces) const;
  void ExchangeJoins();
  Values Below(const PiecesOfLines& pieces, int pair) const;
  void ExchangeParts();
  void Send(const std::vector<Shared>& to, int tag, Part part, const Values& values);
  Values Receive(const std::vector<Shared>& from, int tag, std::size_t width);
  void GoUp(int pair, Slot& slot, double incident, Part part);
  void Join(int pair);
  void GoDown(int pair, Slot& slot, double incident, bool writes);
  void SweepWhole(int pair, double incident, bool writes);
  void SweepCut(int begin, int end, double incident, bool writes);
  std::string Options() const;
  cl::Kernel Kernel(const char* name, int pair, double incident) const;
  void Run(cl::Kernel& kernel, int pair);

  Device& TheDevice;
  const Domain& TheDomain;
  const LatticeBox& Box;
  const LatticeSettings& Settings;
  const LatticeVoxels& Voxels;
  const Lattice* Densities;
  std::vector<Pair> Pairs; ///< none where the block has no voxels
  std::vector<Slot> Slots;
  std::size_t MostPieces = 1;
  ExactValues Straight, Even, Arriving;
  Buffer<float> Passes, Squared, Endless;
  HeldFailure Failure; ///< of a sweep
  double Work = 0.0;
};
}
