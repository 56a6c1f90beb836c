#include "LatticeBoltzmann/Steady/LinesOfLinks.h"

#include "Device/Device.h"
#include "LatticeBoltzmann/LatticeShared.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
/// number of pairs of opposite directions that are swept concurrently, if lines are cut at the faces of blocks
constexpr int PairsAtOnce = 3;
/// Numbers of values per piece in the arrays `sent` (PieceValues) and `joined` (JoinedValues) of LatticeLines.cl. The
/// first SweepValues values per piece in `sent` change from sweep to sweep, and are sent to other ranks in every sweep.
constexpr std::size_t PieceValues = 8, JoinedValues = 3, SweepValues = 2;

/// Extracts the values of own voxels from those of known voxels (own and ghost voxels).
std::vector<float> OwnOf(const LatticeBox& box, const std::vector<float>& known)
{
  if (box.IsAll() || known.empty())
  {
    return known;
  }
  std::vector<float> own;
  for (std::size_t i = 0; i < box.Count(); ++i)
  {
    own.push_back(known[box.Known(i)]);
  }
  return own;
}

/// Fraction of a density that continues straight in each own voxel, Eq. (L7).
std::vector<double> GoesStraight(const LatticeBox& box, const LatticeVoxels& voxels)
{
  std::vector<double> straight;
  for (std::size_t i = 0; i < box.Count(); ++i)
  {
    const std::size_t known = box.Known(i);
    straight.push_back((1.0 - voxels.lost[known]) * (1.0 - voxels.turning[known]));
  }
  return straight;
}
}

LinesOfLinks::LinesOfLinks(Device& device, const LatticeProblem& problem, const LatticeSettings& settings,
  const LatticeVoxels& voxels, const Lattice* lattice)
  : TheDevice(device)
  , TheDomain(problem.TheDomain())
  , Box(problem.Box())
  , Settings(settings)
  , Voxels(voxels)
  , Densities(lattice)
{
  const bool cuts = !this->TheDomain.IsSerial();
  this->TheDomain.Collective([&] {
    if (this->Box.Count() > 0)
    {
      this->Load();
      if (cuts)
      {
        this->LoadCutLines();
      }
    }
  });
  if (cuts)
  {
    this->ExchangeParts();
  }
}

void LinesOfLinks::Load()
{
  const char* what = "lines of the lattice";
  const std::size_t count = this->Box.Count();
  const auto values = [&](std::size_t number) { return ExactValues(this->TheDevice, number, what); };
  this->Straight = values(count);
  this->Even = values(count);
  this->Arriving = values(count);
  this->Straight.Write(GoesStraight(this->Box, this->Voxels));
  this->Passes = Buffer<float>(this->TheDevice, OwnOf(this->Box, this->Voxels.passes), "how links pass light");
  this->Squared = Buffer<float>(this->TheDevice, OwnOf(this->Box, this->Voxels.squared), "n^2");
  this->Endless = Buffer<float>(this->TheDevice, OwnOf(this->Box, this->Voxels.endless), "lines without an end");
  const std::array<bool, 3>& periodic = this->Box.periodic;
  const bool closes = periodic[0] || periodic[1] || periodic[2];
  const bool cuts = !this->TheDomain.IsSerial();
  for (int pair = 0; pair < this->Settings.directions / 2; ++pair)
  {
    this->Pairs.emplace_back();
    this->Pairs.back().range = LinesOfPair(this->Box.own.size, pair);
    this->MostPieces = std::max(this->MostPieces, this->Pairs.back().range[0] * this->Pairs.back().range[1]);
  }
  for (int slot = 0; slot < (cuts ? PairsAtOnce : 1); ++slot)
  {
    this->Slots.push_back({ values(2 * count), values(closes || cuts ? count : 1),
      values(cuts ? PieceValues * this->MostPieces : 1), values(cuts ? JoinedValues * this->MostPieces : 1) });
  }
}

void LinesOfLinks::LoadCutLines()
{
  for (int pair = 0; pair < static_cast<int>(this->Pairs.size()); ++pair)
  {
    const PiecesOfLines pieces(this->TheDomain.Partition(), this->Settings.periodic, pair);
    Pair& of = this->Pairs[pair];
    of = this->LinesFrom(pieces);
    of.below = ExactValues(this->TheDevice, 2 * of.range[0] * of.range[1], "lines of the lattice");
    of.below.Write(this->Below(pieces, pair));
  }
}

/// For a pair of opposite directions, finds the lines that begin in this rank's block, because this rank joins their
/// pieces (one segment per block). Also finds the pieces that it exchanges with other ranks.
LinesOfLinks::Pair LinesOfLinks::LinesFrom(const PiecesOfLines& pieces) const
{
  const int self = this->TheDomain.Rank();
  Pair pair;
  pair.range = pieces.Range(self);
  std::vector<PiecesOfLines::Line> lines;
  // Pieces sent to and received from each rank.
  std::vector<Shared> sent(this->TheDomain.Comm().Ranks()), received = sent;
  pieces.ForLines([&](int joining, const PiecesOfLines::Line& line) {
    for (const PiecesOfLines::Piece& piece : line.pieces)
    {
      if (piece.rank == self)
      {
        sent[joining].pieces.push_back(piece.number);
      }
      if (joining == self)
      {
        received[piece.rank].pieces.push_back(piece.number);
      }
    }
    if (joining == self)
    {
      lines.push_back(line);
    }
  });
  std::vector<std::size_t> next; // for each rank: index, among all received pieces, of the next piece from it
  std::size_t all = 0;
  for (int rank = 0; rank < static_cast<int>(sent.size()); ++rank)
  {
    next.push_back(all);
    all += received[rank].pieces.size();
    sent[rank].rank = received[rank].rank = rank;
    if (!received[rank].pieces.empty())
    {
      pair.receivedFrom.push_back(std::move(received[rank]));
    }
    if (!sent[rank].pieces.empty())
    {
      pair.sentTo.push_back(std::move(sent[rank]));
    }
  }
  for (const PiecesOfLines::Line& line : lines)
  {
    pair.lines.push_back({ {}, line.closed });
    for (const PiecesOfLines::Piece& piece : line.pieces)
    {
      pair.lines.back().places.push_back(next[piece.rank]++);
    }
  }
  return pair;
}

/// The array `below` of LatticeLines.cl: link transmission and n^2 of the voxel before each piece; both 1 if the piece
/// begins at a face of the grid.
LinesOfLinks::Values LinesOfLinks::Below(const PiecesOfLines& pieces, int pair) const
{
  const VoxelBox& block = this->TheDomain.Own();
  const std::array<std::size_t, 2>& range = this->Pairs[pair].range;
  Values below(2 * range[0] * range[1], 1.0);
  pieces.ForPieces(this->TheDomain.Rank(), [&](std::size_t piece, std::array<int, 3> voxel) {
    bool isFace = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel[axis] -= block.first[axis] + LatticeWays[2 * pair][axis];
      const bool isOut = voxel[axis] < 0 || voxel[axis] >= block.size[axis];
      isFace = isFace || (isOut && !(this->Box.innerFaces >> (2 * axis + (voxel[axis] < 0 ? 0 : 1)) & 1));
    }
    if (!isFace)
    {
      const std::size_t known = this->Box.Known(voxel);
      below[2 * piece] = this->Voxels.passes[known];
      below[2 * piece + 1] = this->Voxels.squared[known];
    }
  });
  return below;
}

/// Sends the linear responses of pieces of lines to light at their ends (PieceOfLine), which do not change between
/// sweeps, to the ranks that join the pieces.
void LinesOfLinks::ExchangeParts()
{
  this->Failure = {};
  this->BeginPass(false, false);
  const int pairs = static_cast<int>(this->Pairs.size());
  if (pairs > 0)
  {
    this->Failure.Attempt([&] { this->Even.Fill(0.0); });
  }
  for (int pair = 0; pair < pairs; ++pair)
  {
    this->GoUp(pair, this->Slots.front(), { SweepValues, PieceValues - SweepValues, PieceValues });
    const Values received = this->Receive(this->Pairs[pair].receivedFrom, 2 * pair, PieceValues - SweepValues);
    this->Failure.Attempt([&] {
      for (auto next = received.begin(); next != received.end(); next += PieceValues - SweepValues)
      {
        this->Pairs[pair].parts.push_back({ next[0], next[1], next[2], next[3], next[4], next[5] });
      }
    });
  }
  this->TheDomain.Collective([&] { this->Failure.Throw(); });
}

/// Sends values of pieces of lines to other ranks; after a failure sends empty messages, so that no rank waits.
/// @param part  which values of each piece are sent
/// @param values  values of all pieces of this rank, by number; if `part.of` is 0, only those of the pieces in `to`, in
///   their order
void LinesOfLinks::Send(const std::vector<Shared>& to, int tag, Part part, const Values& values)
{
  auto next = values.begin();
  for (const Shared& other : to)
  {
    Values message;
    this->Failure.Attempt([&] {
      for (const std::size_t piece : other.pieces)
      {
        const auto first =
          part.of > 0 ? values.begin() + static_cast<std::ptrdiff_t>(piece * part.of + part.first) : next;
        next = first + static_cast<std::ptrdiff_t>(part.count);
        message.insert(message.end(), first, next);
      }
    });
    this->TheDomain.Comm().Send(other.rank, tag, this->Failure.broken ? Values() : message);
  }
}

/// Receives values of pieces of lines from other ranks.
/// @return `width` values of each piece, consecutively; undefined after a failure
LinesOfLinks::Values LinesOfLinks::Receive(const std::vector<Shared>& from, int tag, std::size_t width)
{
  Values all;
  for (const Shared& other : from)
  {
    const Values message = this->TheDomain.Comm().Receive<double>(other.rank, tag);
    this->Failure.broken = this->Failure.broken || message.size() != width * other.pieces.size();
    this->Failure.Attempt([&] { all.insert(all.end(), message.begin(), message.end()); });
  }
  return all;
}

std::string LinesOfLinks::Options() const
{
  const LatticeVoxels& voxels = this->Voxels;
  return ExactOption(this->TheDevice) + Define("DIRECTIONS", this->Settings.directions) +
    Define("BENDS", voxels.bends) + Define("PASSES_ALL", voxels.passesAll) + Define("REFLECTS", voxels.Reflects()) +
    Define("PUBLISHED", 0) + Define("ENDLESS", !voxels.endless.empty());
}

/// Runs a kernel of LatticeLines.cl.
/// @param arguments  arguments of the kernel after `even`
template <class... Arguments>
void LinesOfLinks::Run(const char* name, int pair, const Arguments&... arguments)
{
  cl::Kernel kernel = this->TheDevice.Kernel(name, kernel_source::LatticeLines, this->Options());
  this->Pass.pair = pair;
  With(kernel, this->Pass, this->Straight.Handle(), this->Passes, this->Squared, this->Even.Handle(), arguments...);
  const std::array<std::size_t, 2>& range = this->Pairs[pair].range;
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(range[0], range[1]));
  this->TheDevice.Finish();
}

void LinesOfLinks::GoUp(int pair, Slot& slot, Part part)
{
  const std::vector<Shared>& sentTo = this->Pairs[pair].sentTo;
  Values values;
  this->Failure.Attempt([&] {
    this->Run("pieces_up", pair, this->Pairs[pair].below.Handle(), this->Endless, slot.behind.Handle(),
      slot.share.Handle(), slot.sent.Handle());
    values = sentTo.empty() ? Values() : slot.sent.Read();
  });
  this->Send(sentTo, 2 * pair, part, values);
}

/// Joins the pieces of each line that begins in this rank's block, i.e. solves for the light at their ends, and sends
/// each piece's owner the light at its ends.
void LinesOfLinks::Join(int pair)
{
  const Pair& of = this->Pairs[pair];
  const Values received = this->Receive(of.receivedFrom, 2 * pair, SweepValues);
  Values joined;
  this->Failure.Attempt([&] {
    joined.resize(received.size() / SweepValues * JoinedValues);
    for (const Line& line : of.lines)
    {
      std::vector<PieceOfLine> parts;
      std::vector<SentByPiece> sent;
      for (const std::size_t place : line.places)
      {
        parts.push_back(of.parts[place]);
        sent.push_back({ received[SweepValues * place], received[SweepValues * place + 1] });
      }
      const std::vector<ComesToPiece> comes = JoinLine(parts, sent, line.closed);
      for (std::size_t k = 0; k < comes.size(); ++k)
      {
        const auto to = joined.begin() + static_cast<std::ptrdiff_t>(JoinedValues * line.places[k]);
        to[0] = comes[k].up;
        to[1] = comes[k].down;
        to[2] = comes[k].sentBeyond;
      }
    }
  });
  this->Send(of.receivedFrom, 2 * pair + 1, { 0, JoinedValues, 0 }, joined);
}

void LinesOfLinks::GoDown(int pair, Slot& slot)
{
  const std::vector<Shared>& sentTo = this->Pairs[pair].sentTo;
  const Values received = this->Receive(sentTo, 2 * pair + 1, JoinedValues);
  this->Failure.Attempt([&] {
    Values joined(JoinedValues * this->MostPieces, 0.0);
    auto next = received.begin();
    for (const Shared& other : sentTo)
    {
      for (const std::size_t piece : other.pieces)
      {
        std::copy_n(next, JoinedValues, joined.begin() + static_cast<std::ptrdiff_t>(JoinedValues * piece));
        next += JoinedValues;
      }
    }
    slot.joined.Write(joined);
    this->Run("pieces_down", pair, this->Pairs[pair].below.Handle(), this->Endless, slot.behind.Handle(),
      slot.share.Handle(), slot.joined.Handle(), this->Arriving.Handle(), this->Densities->Densities());
  });
}

/// Sweeps the lines of a pair of opposite directions in a serial solve, where no line is cut between blocks.
void LinesOfLinks::SweepWhole(int pair)
{
  const Slot& slot = this->Slots.front();
  this->Run("sweep_lines", pair, slot.behind.Handle(), slot.share.Handle(), this->Arriving.Handle(),
    this->Densities->Densities(), this->Endless);
}

/// Sweeps the lines of the pairs of directions [begin, end) concurrently, if lines are cut at the faces of blocks. A
/// rank computes one pair while it waits for messages of another.
void LinesOfLinks::SweepCut(int begin, int end)
{
  for (int pair = begin; pair < end; ++pair)
  {
    this->GoUp(pair, this->Slots[pair - begin], { 0, SweepValues, PieceValues });
  }
  for (int pair = begin; pair < end; ++pair)
  {
    this->Join(pair);
  }
  for (int pair = begin; pair < end; ++pair)
  {
    this->GoDown(pair, this->Slots[pair - begin]);
  }
}

void LinesOfLinks::BeginPass(bool withIncident, bool writes)
{
  this->Pass = {};
  this->Pass.writes = writes;
  if (this->Densities)
  {
    this->Pass.lattice = this->Densities->Info();
    std::transform(std::begin(this->Pass.lattice.incoming), std::end(this->Pass.lattice.incoming),
      std::begin(this->Pass.lattice.incoming), [&](float light) { return withIncident ? light : 0.0f; });
  }
}

LinesOfLinks::Values LinesOfLinks::Sweep(const Values& even, bool withIncident, bool writes, const Monitor& monitor)
{
  this->Failure = {};
  this->BeginPass(withIncident, writes);
  const int pairs = static_cast<int>(this->Pairs.size());
  this->Failure.Attempt([&] {
    if (pairs > 0)
    {
      this->Even.Write(even);
      this->Arriving.Fill(0.0);
    }
  });
  const bool cuts = !this->TheDomain.IsSerial();
  const int atOnce = cuts ? PairsAtOnce : 1;
  for (int begin = 0; begin < pairs; begin += atOnce)
  {
    const int end = std::min(begin + atOnce, pairs);
    if (cuts)
    {
      this->SweepCut(begin, end);
    }
    this->Failure.Attempt([&] {
      if (!cuts)
      {
        this->SweepWhole(begin);
      }
      this->Work += end - begin;
      // The reported progress only approaches 1, because the number of sweeps is not known in advance.
      Report(monitor, 1.0 - 1.0 / (1.0 + 0.01 * this->Work));
    });
  }
  Values arrives;
  this->TheDomain.Collective([&] {
    this->Failure.Throw();
    if (pairs > 0 && !this->Failure.broken)
    {
      arrives = this->Arriving.Read();
    }
  });
  return arrives;
}
}
