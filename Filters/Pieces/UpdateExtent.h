#pragma once

#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkType.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

class vtkDataSetAttributes;
class vtkImageData;
class vtkInformationKey;
class vtkInformationVector;
class vtkUnsignedCharArray;

/// Update extents of filters whose light crosses the boundaries between pieces: they ask for all of their inputs (if a
/// source does not give it to each rank: WholeInputs.h), work on that, and keep the piece that is asked for.
namespace tyndall
{
/// A box of cells or of points, with its bounds; x fastest.
struct ValueBox
{
  std::array<int, 3> low = { 0, 0, 0 };
  std::array<int, 3> high = { -1, -1, -1 };

  bool IsEmpty() const
  {
    return this->low[0] > this->high[0] || this->low[1] > this->high[1] || this->low[2] > this->high[2];
  }
  std::size_t Along(int axis) const { return static_cast<std::size_t>(this->high[axis] - this->low[axis] + 1); }
  std::size_t Count() const { return this->IsEmpty() ? 0 : this->Along(0) * this->Along(1) * this->Along(2); }
  bool Holds(const std::array<int, 3>& at) const
  {
    return at[0] >= this->low[0] && at[0] <= this->high[0] && at[1] >= this->low[1] && at[1] <= this->high[1] &&
      at[2] >= this->low[2] && at[2] <= this->high[2];
  }
  void Add(const ValueBox& other); ///< so that the other is in it, too

  /// Calls act with the index of each value and its place.
  template <typename Do>
  void ForEach(const Do& act) const
  {
    vtkIdType index = 0;
    std::array<int, 3> at;
    for (at[2] = this->low[2]; at[2] <= this->high[2]; ++at[2])
    {
      for (at[1] = this->low[1]; at[1] <= this->high[1]; ++at[1])
      {
        for (at[0] = this->low[0]; at[0] <= this->high[0]; ++at[0])
        {
          act(index++, at);
        }
      }
    }
  }
};

/// The points of an extent.
ValueBox PointBoxOf(const std::array<int, 6>& extent);
/// Its cells; a flat one has one layer of them.
ValueBox CellBoxOf(const std::array<int, 6>& extent);

/// The least extent of the points of cells that are no duplicates, or of the points if these are flagged
/// (vtkGhostType); inverted if there are none.
std::array<int, 6> ExtentWithoutDuplicates(
  const std::array<int, 6>& extent, vtkUnsignedCharArray* flags, bool flagsPoints);

/// Adds a flag to vtkGhostType of the values that are duplicates. Other flags stay, and so do the arrays of the input,
/// which the image may share.
void FlagDuplicates(vtkDataSetAttributes* attributes, const ValueBox& box, unsigned char flag,
  const std::function<bool(const std::array<int, 3>&)>& isDuplicate);

/// In RequestUpdateExtent: asks the inputs of a port for all of their image, or all pieces of their polydata.
/// @param request, outputs  those of RequestUpdateExtent
void AskForAll(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs);
/// The inputs of a port are asked for what is asked of the output, as the pipeline does.
void AskForSame(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs);
/// AskForAll for all ports but one, for which it is AskForSame.
/// @param ports  their number
/// @param piece  that one; -1: none
/// @param besides  further ones
void AskForAllBut(int piece, vtkInformation* request, vtkInformationVector** inputs, int ports,
  vtkInformationVector* outputs, const std::vector<int>& besides = {});

/// Asks for this rank's piece with one layer of ghost cells if ranks run the filter together; else AskForAll.
void AskForPiece(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs);

/// In RequestData: the output port that asks.
vtkInformation* AskingPort(vtkInformation* request, vtkInformationVector* outputs);

/// In RequestData: whether the first piece is asked for, which gets what is not divided. Taken from the port that asks;
/// other ports may not know their piece yet.
bool IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs);

/// In RequestData: records that ranks are asked for parts of an output that are not the extent translator's pieces, but
/// those that the source of each rank announces.
/// @param parts  an extent for each rank; none: they are pieces
/// @param rank   this one
void NotePartsOfRanks(vtkInformation* information, const std::vector<std::array<int, 6>>& parts, int rank);

/// The requested piece of an image's extent, with ghost cells and without; all of it if it is not divided. Empty if
/// there are more pieces than cells.
struct AskedPiece
{
  static constexpr std::array<int, 6> Nothing = { 0, -1, 0, -1, 0, -1 };

  std::array<int, 6> withGhosts = Nothing;
  std::array<int, 6> own = Nothing;
  bool IsEmpty() const
  {
    const std::array<int, 6>& extent = this->withGhosts;
    return extent[0] > extent[1] || extent[2] > extent[3] || extent[4] > extent[5];
  }
};
AskedPiece AskedPieceOf(vtkInformation* information, const std::array<int, 6>& whole);

/// A piece of an extent by VTK's translator; empty if there are more pieces than cells.
std::array<int, 6> PartOfExtent(const std::array<int, 6>& whole, int piece, int pieces, int ghostLevels = 0);

/// Crops an image to a piece of it, and marks its ghost cells (vtkGhostType); empties it if the piece is empty.
void KeepPiece(const AskedPiece& piece, vtkImageData* output);

/// Whether one extent contains another; six numbers each.
bool Covers(const int* extent, const int* other);

/// Whether the update extent of an output is all of it: the whole extent, or an earlier one of another time step. A
/// consumer may not know the new one: VTK announces extents before it requests a time step.
bool AsksForAll(vtkInformation* information);
/// In RequestData; KeepWhatIsAskedFor does it.
void NoteExtentTold(vtkInformation* information);

/// Restores an update request, which VTK resets when a source announces a new extent. A request for all of the old
/// extent becomes one for all of the new.
class UpdateRequest
{
public:
  explicit UpdateRequest(vtkInformation* information); ///< must outlive it
  void Restore() const;

private:
  static std::array<vtkInformationKey*, 4> Keys(); ///< the extent last

  vtkInformation* Information;
  vtkNew<vtkInformation> Before;
  bool All;
};

/// In RequestData: the extent that KeepWhatIsAskedFor leaves of an image; inverted if it is empty.
std::array<int, 6> ExtentAskedFor(vtkInformation* information, const std::array<int, 6>& image);

/// In RequestData: crops the output to the extent, or the piece of it, that was asked for. Ghost cells are marked
/// (vtkGhostType), so that sums over pieces count them once.
void KeepWhatIsAskedFor(vtkInformation* information, vtkImageData* output);

/// In RequestData: announces the extent of an output that is not known before it is made. Otherwise the pipeline would
/// run the filter again for what its guess has beyond it.
/// @param asking  the port that asks: VTK assumes that all ports then have its piece
void TellExtent(vtkInformation* asking, vtkInformation* information, const int extent[6]);

/// The same for an image, which is then cropped to the piece that was asked for.
void TellExtentAndKeepWhatIsAskedFor(vtkInformation* asking, vtkInformation* information, vtkImageData* output);
}
