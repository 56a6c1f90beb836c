#ifndef vtkRefractionOctree_h
#define vtkRefractionOctree_h

#include "PropertyRange.h"
#include "vtkImageAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <string>

namespace tyndall
{
class PieceBlocks;
struct Octree;
}

class vtkImageData;

/**
 * @class vtkRefractionOctree
 * @brief groups voxels of nearly equal refractive index, so that photons cross them in one step
 *
 * Input: vtkImageData with cell array `ior` (refractive index, 1 component, above 0), or the array chosen by
 * SetInputArrayToProcess 0; with IncludeExtinction also `sigma_a` and `sigma_s` (1 or 3 components, 1/length), or the
 * arrays chosen as 1 and 2. For point arrays see SetPointData.
 *
 * Output 0: the input with cell array `octree_level` (uint8: 0 a single voxel, k a node of 2^k voxels per edge) and
 * field data `left_out` (computations that the scene did not need) and `device`.
 * Output 1: the octree as vtkHyperTreeGrid, for viewing. The leaves are the nodes, with cell array `octree_level`.
 *
 * A node of level k > 0 is the cube of 2^k voxels per edge whose lowest voxel has indices, counted from the image's
 * lower corner, that are multiples of 2^k. It is a node if
 *
 *     max(ior) - min(ior) <= Tolerance
 *     (max(sigma_t) - min(sigma_t)) diagonal of the node <= ExtinctionTolerance       with IncludeExtinction
 *
 * over the cube's voxels (the second condition in each channel of sigma_t = sigma_a + sigma_s), and no larger node
 * contains it. A constant quantity imposes no restriction: if ior is constant the octree is one node and nothing runs
 * on the device.
 *
 * A grid whose size is not a power of two is extended by repeating its last voxels, so that nodes at its upper faces
 * may extend beyond the grid. In output 1 nodes entirely outside the grid are masked.
 *
 * In a parallel pipeline every rank works on its piece, and ranks exchange data on nodes that span several pieces: the
 * levels are those of a serial run. Output 1 of each rank has the trees whose first voxel is in the rank's piece. If
 * the pieces do not tile one grid, the first rank works on the whole image and sends each rank the requested piece of
 * output 0; output 1 is then on the first rank.
 *
 * Cells that `vtkGhostType` marks as hidden are empty.
 *
 * @sa vtkMeshVoxelizer vtkPhotonMarcher
 * @par Thanks
 * M. Pfeuti, Real-time Rendering of Refractive Objects in Participating Media, 2009, section 3.1.3.
 */
class TYNDALL_EXPORT vtkRefractionOctree : public vtkImageAlgorithm
{
public:
  static vtkRefractionOctree* New();
  vtkTypeMacro(vtkRefractionOctree, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Largest difference of refractive index within a node. Default 0.01, valid [0, 1]; with 0 only voxels of equal
  /// index form a node.
  tyndallRangeMacro(Tolerance, double, 0.0, 1.0);
  ///@}

  ///@{
  /// Whether extinction must also be nearly equal within a node (see ExtinctionTolerance). Default off.
  tyndallFlagMacro(IncludeExtinction);
  ///@}

  ///@{
  /// With IncludeExtinction: largest error of the optical thickness along a straight path through a node, if extinction
  /// is taken as constant in the node. Default 0.1, valid [0, infinity).
  tyndallRangeMacro(ExtinctionTolerance, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Whether to skip the index or the extinction if it is constant. Default on; off: for comparison, with the same
  /// nodes in more time.
  tyndallFlagMacro(LeaveOut);
  ///@}

  ///@{
  /// How point arrays are read. 0 (default): each point is the centre of a voxel with its value: n points make n
  /// voxels, the output has cell arrays, and its bounds are half a spacing wider than the input's. 1: points are
  /// averaged to the voxels between them: n points make n - 1 voxels. If a cell array is read as well, the cells are
  /// the voxels and points are averaged; field data `settings_used` then report it.
  tyndallPointDataMacro();
  ///@}

  tyndallDeviceMacro();

  ///@{
  /// Results of the last update: number of nodes, run time in seconds, the device's name
  /// (empty if no device was needed), and the computations that the scene did not need, one per line.
  vtkGetMacro(NodeCount, vtkIdType);
  tyndallSecondsMacro();
  vtkGetCharFromStdStringMacro(DeviceName);
  tyndallLeftOutMacro();
  ///@}

protected:
  vtkRefractionOctree();
  ~vtkRefractionOctree() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int FillOutputPortInformation(int port, vtkInformation* information) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkRefractionOctree(const vtkRefractionOctree&) = delete;
  void operator=(const vtkRefractionOctree&) = delete;

  void Build(const tyndall::PieceBlocks& pieces, vtkImageData* image, vtkInformationVector* outputs);
  void Write(vtkImageData* input, vtkImageData* output, tyndall::Octree&& octree);

  int PointData = VOXELS_AROUND_POINTS;
  double Tolerance;
  bool IncludeExtinction;
  bool LeaveOut;
  double ExtinctionTolerance;
  std::string Device;

  vtkIdType NodeCount = 0;
  std::string DeviceName;
};

#endif
