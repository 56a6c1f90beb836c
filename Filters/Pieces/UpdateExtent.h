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

/// Update extents of filters in which light crosses the boundaries between pieces. Such a filter requests its complete
/// inputs (WholeInputs.h gathers them if a source does not deliver everything to each rank), works on these, and keeps
/// the requested piece of the output.
namespace tyndall
{
/// A box of cells or of points with inclusive bounds; x varies fastest.
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
  void Add(const ValueBox& other); ///< extends this box to contain `other`

  /// Calls act(index, position) for each value, x fastest.
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

/// The box of an extent's points.
ValueBox PointBoxOf(const std::array<int, 6>& extent);
/// The box of an extent's cells; a flat extent has one layer of cells.
ValueBox CellBoxOf(const std::array<int, 6>& extent);

/// The smallest extent that contains all cells that vtkGhostType does not flag as duplicates, or all such points if the
/// flags belong to points. Inverted if there are none.
std::array<int, 6> ExtentWithoutDuplicates(
  const std::array<int, 6>& extent, vtkUnsignedCharArray* flags, bool flagsPoints);

/// Sets a flag in vtkGhostType for values that are duplicates. Other flags remain. The input's arrays, which the image
/// may share, are not changed.
void FlagDuplicates(vtkDataSetAttributes* attributes, const ValueBox& box, unsigned char flag,
  const std::function<bool(const std::array<int, 3>&)>& isDuplicate);

/// In RequestUpdateExtent: requests the complete image, or all pieces of polydata, from the inputs of a port.
/// @param request, outputs  those of RequestUpdateExtent
void AskForAll(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs);
/// Requests from the inputs of a port what is requested from the output, as the pipeline does by default.
void AskForSame(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs);
/// Calls AskForAll for all ports except one or a few, and AskForSame for these.
/// @param ports    number of input ports
/// @param piece    port for AskForSame; -1: none
/// @param besides  further ports for AskForSame
void AskForAllBut(int piece, vtkInformation* request, vtkInformationVector** inputs, int ports,
  vtkInformationVector* outputs, const std::vector<int>& besides = {});

/// Requests this rank's piece with one layer of ghost cells if ranks run the filter together; otherwise calls
/// AskForAll.
void AskForPiece(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs);

/// In RequestData: information of the output port from which the request came.
vtkInformation* AskingPort(vtkInformation* request, vtkInformationVector* outputs);

/// In RequestData: whether the first piece is requested, which receives data that cannot be divided. Determined from
/// the port that the request came from; the requests of other ports may not be set yet.
bool IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs);

/// In RequestData: records which part of an output each rank is asked for, if these are not the pieces of VTK's extent
/// translator but those that each rank's source announces.
/// @param parts  one extent for each rank; empty: the translator's pieces
/// @param rank   this rank
void NotePartsOfRanks(vtkInformation* information, const std::vector<std::array<int, 6>>& parts, int rank);

/// The requested piece of an image's extent, with and without ghost cells; the complete extent if it is not divided.
/// Empty if there are more pieces than cells.
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

/// A piece of an extent according to VTK's extent translator; empty if there are more pieces than cells.
std::array<int, 6> PartOfExtent(const std::array<int, 6>& whole, int piece, int pieces, int ghostLevels = 0);

/// Crops an image to a piece and flags its ghost cells (vtkGhostType); makes it empty if the piece is empty.
void KeepPiece(const AskedPiece& piece, vtkImageData* output);

/// Whether the first extent contains the other one; six numbers each.
bool Covers(const int* extent, const int* other);

/// Whether the update extent of an output is its whole extent, or a whole extent announced earlier for another time
/// step. A consumer may not know the current one: VTK announces extents before it requests a time step.
bool AsksForAll(vtkInformation* information);
/// In RequestData: records the announced whole extent for AsksForAll. KeepWhatIsAskedFor calls it.
void NoteExtentTold(vtkInformation* information);

/// Saves and restores an update request, which VTK resets if a source announces a new extent. A request for the
/// complete old extent becomes a request for the complete new one.
class UpdateRequest
{
public:
  explicit UpdateRequest(vtkInformation* information); ///< must outlive it
  void Restore() const;

private:
  static std::array<vtkInformationKey*, 4> Keys(); ///< the extent is the last one

  vtkInformation* Information;
  vtkNew<vtkInformation> Before;
  bool All;
};

/// In RequestData: the extent to which KeepWhatIsAskedFor will crop an image; inverted if it is empty.
std::array<int, 6> ExtentAskedFor(vtkInformation* information, const std::array<int, 6>& image);

/// In RequestData: crops the output to the requested extent or piece. Ghost cells are flagged (vtkGhostType), so that
/// sums over pieces count each cell once.
void KeepWhatIsAskedFor(vtkInformation* information, vtkImageData* output);
/// The same for an output of which this rank has only the requested part.
/// @param image  extent of the complete output
void KeepWhatIsAskedFor(vtkInformation* information, vtkImageData* output, const std::array<int, 6>& image);

/// In RequestData: announces the extent of an output that becomes known only when it is made. Otherwise the pipeline
/// would run the filter again for the part of its guess that lies beyond this extent. Its pieces are those of VTK's
/// extent translator.
/// @param asking  the port that the request came from: VTK assumes that all ports then have its piece
void TellExtent(vtkInformation* asking, vtkInformation* information, const int extent[6]);
}
