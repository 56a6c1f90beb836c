#pragma once

#include "Device/Buffer.h"
#include "Device/ExactValues.h"
#include "Device/Monitor.h"
#include "Distribution/Communicator.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "LatticeBoltzmann/Steady/PiecesOfLines.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Streaming of light along lines of links, for given light that collisions emit isotropically (numerics.md, Eqs. (L7)
/// to (L10)). Each line is solved directly, by an upward pass and a downward pass. A line that crosses several blocks
/// is solved in pieces: each rank runs the upward pass of its pieces, the rank in whose block the line begins joins the
/// pieces, and each rank runs the downward pass. The result equals that of one rank, to rounding.
class LinesOfLinks
{
public:
  using Values = std::vector<double>;

  /// Collective. All arguments must outlive this.
  /// @param lattice  lattice of the block, whose densities are written; null if the block has no voxels
  LinesOfLinks(Device& device, const LatticeProblem& problem, const LatticeSettings& settings,
    const LatticeVoxels& voxels, const Lattice* lattice);

  /// Transports light along all lines of links. Collective.
  /// @param even  light that collisions and sources emit isotropically, W / length^2, by own voxel
  /// @param withIncident  whether light is incident through the faces of the grid
  /// @param writes  whether the lattice's densities are written, including those beyond the block's faces
  /// @return light that arrives in each own voxel, summed over directions, W / length^2
  Values Sweep(const Values& even, bool withIncident, bool writes, const Monitor& monitor);

private:
  /// Pieces (segments of lines in one block) whose values this rank exchanges with another rank: their numbers in the
  /// block, in an order that both ranks know.
  struct Shared
  {
    int rank = 0;
    std::vector<std::size_t> pieces;
  };
  /// A line whose pieces (segments in one block each) this rank joins: for each piece, its index among all pieces whose
  /// values this rank receives.
  struct Line
  {
    std::vector<std::size_t> places;
    bool closed = false;
  };
  struct Pair
  {
    std::array<std::size_t, 2> range = {}; ///< range of work-items of the kernels
    /// Pieces of lines in this rank's block, by the rank that joins the pieces of their lines.
    std::vector<Shared> sentTo;
    /// pieces of the lines that this rank joins, by the rank in whose block each lies
    std::vector<Shared> receivedFrom;
    std::vector<Line> lines;
    std::vector<PieceOfLine> parts; ///< linear responses of the received pieces to light at their ends
    ExactValues below;
  };
  /// Values of a piece that are sent: `count` values, from index `first` on, of the `of` values that an array has for
  /// each piece of a line.
  struct Part
  {
    std::size_t first = 0, count = 0, of = 0;
  };
  struct Slot ///< scratch arrays of LatticeLines.cl for one pair of directions
  {
    ExactValues behind, share, sent, joined;
  };

  void Load();
  void LoadCutLines();
  Pair LinesFrom(const PiecesOfLines& pieces) const;
  Values Below(const PiecesOfLines& pieces, int pair) const;
  void ExchangeParts();
  void Send(const std::vector<Shared>& to, int tag, Part part, const Values& values);
  Values Receive(const std::vector<Shared>& from, int tag, std::size_t width);
  void GoUp(int pair, Slot& slot, Part part);
  void Join(int pair);
  void GoDown(int pair, Slot& slot);
  void SweepWhole(int pair);
  void SweepCut(int begin, int end);
  std::string Options() const;
  void BeginPass(bool withIncident, bool writes);
  template <class... Arguments>
  void Run(const char* name, int pair, const Arguments&... arguments);

  Device& TheDevice;
  const Domain& TheDomain;
  const LatticeBox& Box;
  const LatticeSettings& Settings;
  const LatticeVoxels& Voxels;
  const Lattice* Densities;
  std::vector<Pair> Pairs; ///< lines of each pair of directions; empty if the block has no voxels
  std::vector<Slot> Slots;
  std::size_t MostPieces = 1;
  ExactValues Straight, Even, Arriving;
  Buffer<float> Passes, Squared, Endless;
  LinePass Pass = {};  ///< parameters of the current sweep
  HeldFailure Failure; ///< first failure of the current sweep
  double Work = 0.0;
};
}
