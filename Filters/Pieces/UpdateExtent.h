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
/// inputs (WholeInputs.h gathers pieces if a source does not deliver everything to each rank), works on the complete
/// inputs, and keeps the requested piece of the output.
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
  void Add(const ValueBox& other); ///< extends this box so that it contains `other`

  /// Calls act(index, position) for each value of the box, x fastest. `index` counts from 0.
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

/// Box of an extent's points.
ValueBox PointBoxOf(const std::array<int, 6>& extent);
/// Box of an extent's cells; a flat extent has one layer of cells.
ValueBox CellBoxOf(const std::array<int, 6>& extent);

/// Smallest extent that contains all cells, or all points if `flags` belong to points, that vtkGhostType does not flag
/// as duplicates. Inverted (first index above the last) if there are none.
std::array<int, 6> ExtentWithoutDuplicates(
  const std::array<int, 6>& extent, vtkUnsignedCharArray* flags, bool flagsPoints);

/// Sets the bit `flag` in vtkGhostType for values of a box that are duplicates; other bits remain. A new array is made:
/// the array of the input, which the image may share, is not changed.
void FlagDuplicates(vtkDataSetAttributes* attributes, const ValueBox& box, unsigned char flag,
  const std::function<bool(const std::array<int, 3>&)>& isDuplicate);

/// Requests the complete image, or all pieces of polydata, from the inputs of a port. Called in RequestUpdateExtent.
/// @param request, outputs  parameters of RequestUpdateExtent
void AskForAll(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs);
/// Requests from the inputs of a port the same part that is requested from the output, as VTK's pipeline does by
/// default.
void AskForSame(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs);
/// Calls AskForSame for one or a few input ports, and AskForAll for all others.
/// @param ports    number of input ports
/// @param piece    port for AskForSame; -1: none
/// @param besides  further ports for AskForSame
void AskForAllBut(int piece, vtkInformation* request, vtkInformationVector** inputs, int ports,
  vtkInformationVector* outputs, const std::vector<int>& besides = {});

/// Requests from the inputs of a port this rank's piece with one layer of ghost cells, if ranks run the filter
/// together; otherwise calls AskForAll.
void AskForPiece(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs);

/// Information of the output port from which a request came. Called in RequestData.
vtkInformation* AskingPort(vtkInformation* request, vtkInformationVector* outputs);

/// Whether the first piece is requested, which receives data that cannot be divided. Determined from the output port
/// that the request came from; the requests of other ports may not be set yet. Called in RequestData.
bool IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs);

/// Records which part of an output is requested from each rank, if the parts are not the pieces of VTK's extent
/// translator, but pieces that the ranks' sources announce. Called in RequestData.
/// @param parts  one extent for each rank; empty: the translator's pieces
/// @param rank   this rank
void NotePartsOfRanks(vtkInformation* information, const std::vector<std::array<int, 6>>& parts, int rank);

/// The requested piece of an image's extent, with and without ghost cells: the complete extent if it is not divided,
/// and empty if there are more pieces than cells.
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

/// Computes a piece of an extent with VTK's extent translator; empty if there are more pieces than cells.
std::array<int, 6> PartOfExtent(const std::array<int, 6>& whole, int piece, int pieces, int ghostLevels = 0);

/// Crops an image to a piece and flags its ghost cells (vtkGhostType); an empty piece leaves an empty image.
void KeepPiece(const AskedPiece& piece, vtkImageData* output);

/// Whether an extent of VTK, six numbers, contains the extent `other`.
bool Covers(const int* extent, const int* other);

/// Whether the update extent of an output is its whole extent, or a whole extent announced earlier for another time
/// step. A filter downstream may not know the current whole extent: VTK announces extents before it requests a time
/// step.
bool AsksForAll(vtkInformation* information);
/// Records the announced whole extent of an output, so that AsksForAll recognises it in later requests. Called in
/// RequestData, also by KeepWhatIsAskedFor.
void NoteExtentTold(vtkInformation* information);

/// Saves and restores an update request, which VTK resets if a source announces a new extent. A request for the
/// complete old extent becomes a request for the complete new extent.
class UpdateRequest
{
public:
  explicit UpdateRequest(vtkInformation* information); ///< `information` must outlive this object
  void Restore() const;

private:
  static std::array<vtkInformationKey*, 4> Keys(); ///< information keys of an update request; the extent's is last

  vtkInformation* Information;
  vtkNew<vtkInformation> Before;
  bool All;
};

/// Extent to which KeepWhatIsAskedFor will crop an image in RequestData; inverted (first index above the last) if it is
/// empty.
std::array<int, 6> ExtentAskedFor(vtkInformation* information, const std::array<int, 6>& image);

/// Crops an output to the requested extent or piece, and flags its ghost cells (vtkGhostType), so that sums over pieces
/// count each cell once. Called in RequestData.
void KeepWhatIsAskedFor(vtkInformation* information, vtkImageData* output);
/// Crops an output to the requested extent or piece, for a rank that made only this part of the complete output.
/// @param image  extent of the complete output
void KeepWhatIsAskedFor(vtkInformation* information, vtkImageData* output, const std::array<int, 6>& image);

/// Announces the extent of an output that becomes known only when the output is made, in RequestData. If the pipeline
/// assumed a larger extent, it would otherwise run the filter again for the missing part. Pieces of the output are
/// those of VTK's extent translator.
/// @param asking  information of the output port that the request came from; VTK assumes that all ports then have the
///   piece of this port
void TellExtent(vtkInformation* asking, vtkInformation* information, const int extent[6]);
}
