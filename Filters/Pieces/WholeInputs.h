#pragma once

#include "Common/ImageInput.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <functional>
#include <memory>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformation;
class vtkInformationVector;
class vtkMultiProcessController;

namespace tyndall
{
/// In RequestData: a filter's inputs, the same on all ranks that run it together (Ranks.h).
///
/// Light crosses the boundaries between pieces, so most filters ask for all of their inputs (AskForAll,
/// UpdateExtent.h). If the source gives every rank all of it, only a digest is exchanged. If ranks have pieces, as from
/// Resample To Image or a file that only one rank can read, every rank gets all of them: an image is gathered
/// (GatheredImage.h) with its cell and point arrays, ghost cells once; other data, such as tables and lights, are
/// broadcast from the rank that has them. Points that are distributed among ranks are appended in the order of ranks.
///
/// Images that a filter reads as voxels get axes along those of the world if they are a permutation of those. If the
/// first input is rotated otherwise, the filter works in its axes (OwnAxes), the same on all ranks. Images of which
/// point arrays are read get a voxel around each point (Common/ImageInput.h), on one rank, too; the voxels of a plane
/// of points that pieces share belong to the lowest rank.
///
/// Memory of each rank: the whole image, and one piece of one array.
class WholeInputs
{
public:
  static constexpr int NoPort = -1;

  /// @param ranks  null: this process is alone
  /// @param given  by port
  /// @param outputs  get the parts that are asked of each rank, for KeepWhatIsAskedFor
  /// @param inPieces  a port that stays in pieces until MakeWhole, and whose data Replace sets
  /// @param alsoInPieces  further ones
  /// @param inShares  another, of points (photons) that are distributed among ranks
  /// @throws InvalidInput the same on all ranks if pieces cannot be gathered
  WholeInputs(vtkMultiProcessController* ranks, vtkAlgorithm* filter, vtkInformationVector** given,
    vtkInformationVector* outputs, int inPieces = NoPort, int inShares = NoPort,
    const std::vector<int>& alsoInPieces = {});
  ~WholeInputs();

  /// By port.
  vtkInformationVector** Vectors() { return this->Ports.data(); }

  /// Rotates outputs from the medium's own axes into the scene.
  void PutIntoScene(vtkInformationVector* outputs);

  /// Replaces the data of the port that stays in pieces, until MakeWhole.
  void Replace(vtkDataObject* data);

  /// Gathers the ports that stayed in pieces. Collective.
  /// @throws InvalidInput as the constructor
  void MakeWhole();

private:
  struct Seen; ///< summaries of the inputs on all ranks
  void MakeWhole(int port);
  using ToOther = std::function<vtkSmartPointer<vtkDataObject>(int connection, vtkDataObject* data)>;
  void AlignGiven(vtkInformationVector** given);
  void AgreeOnAxes(vtkMultiProcessController* ranks);
  void TurnGiven();
  void NoteAveragedArrays();
  void Change(int port, const ToOther& change);

  vtkAlgorithm* Filter;
  std::vector<vtkSmartPointer<vtkInformationVector>> Given; ///< by port, images with aligned axes
  OwnAxes Axes;                                             ///< of the first port's
  vtkSmartPointer<vtkDataObject> Medium;                    ///< the same image in the scene; null: none

  std::unique_ptr<Seen> AllSeen; ///< null: this process is alone
  std::vector<vtkSmartPointer<vtkInformationVector>> Kept;
  std::vector<vtkInformationVector*> Ports;
};
}
