#pragma once

#include "Pieces/AlignedInputs.h"
#include "Pieces/GatheredImage.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformationVector;
class vtkMultiProcessController;

namespace tyndall
{
/// The complete inputs of a filter in RequestData, the same on all ranks that run the filter together (Ranks.h).
///
/// Light crosses the boundaries between pieces, so most filters request their complete inputs (AskForAll,
/// UpdateExtent.h). If the source gives every rank the complete input, only a hash is exchanged. If ranks have pieces,
/// as from Resample To Image or from a file that only one rank can read, every rank receives all of them: an image is
/// gathered (GatheredImage.h) with its cell and point arrays, each ghost cell once; other data, such as tables and
/// lights, are broadcast from the rank that has them. Points that are distributed among ranks are appended in the order
/// of ranks.
///
/// Images are aligned first (AlignedInputs.h). Images whose point arrays are read get a voxel around each point
/// (Common/ImageInput.h), also on a single rank. If pieces share a plane of points, its voxels belong to the lowest
/// rank.
///
/// Memory per rank: the complete image, and one piece of one array.
class WholeInputs
{
public:
  static constexpr int NoPort = -1;

  /// Gathers the inputs, except those that stay in pieces. Collective.
  /// @param ranks  null: this process is alone
  /// @param given  the filter's inputs by port
  /// @param outputs  information objects that receive the part which each rank is asked for, for KeepWhatIsAskedFor
  /// @param inPieces  port whose data stay in pieces until MakeWhole; Replace sets the data of this port
  /// @param alsoInPieces  further ports whose data stay in pieces
  /// @param inShares  port of points (photons) that stay distributed among ranks until MakeWhole
  /// @throws InvalidInput, the same on all ranks, if pieces cannot be gathered
  WholeInputs(vtkMultiProcessController* ranks, vtkAlgorithm* filter, vtkInformationVector** given,
    vtkInformationVector* outputs, int inPieces = NoPort, int inShares = NoPort,
    const std::vector<int>& alsoInPieces = {});
  ~WholeInputs();

  /// The inputs by port, in the form that RequestData receives them.
  vtkInformationVector** Vectors() { return this->Ports.data(); }

  /// Rotates output images from the medium axes (OwnAxes), in which the filter has worked, back to the scene axes.
  void PutIntoScene(vtkInformationVector* outputs) { this->Aligned.PutIntoScene(outputs); }

  /// Replaces the data at the port `inPieces` of the constructor, until MakeWhole.
  void Replace(vtkDataObject* data);

  /// Gathers the data of the ports that have stayed in pieces. Collective.
  /// @param where  ranks that receive the complete data; on the other ranks these ports keep their pieces
  /// @throws InvalidInput as the constructor does
  void MakeWhole(GatheredImage::On where = GatheredImage::On::EveryRank);

private:
  struct Seen; ///< summaries of the inputs on all ranks
  void MakeWhole(int port, GatheredImage::On where);
  void Change(int port, const ChangeOfData& change);

  AlignedInputs Aligned;
  std::unique_ptr<Seen> AllSeen; ///< summaries of the inputs on all ranks; null: this process is alone
  std::vector<vtkSmartPointer<vtkInformationVector>> Kept;
  std::vector<vtkInformationVector*> Ports;
};
}
