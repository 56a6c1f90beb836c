#ifndef vtkVDBReader_h
#define vtkVDBReader_h

#include "PropertyRange.h"
#include "vtkImageAlgorithm.h"
#include "vtkNew.h"           // for members
#include "vtkTyndallModule.h" // for export macro

#include <array>
#include <memory>

class vtkDataArraySelection;

/**
 * @class vtkVDBReader
 * @brief reads grids of an OpenVDB file (.vdb) as one image, one cell per voxel
 *
 * Output: vtkImageData with a cell array for each chosen grid, named after the grid.
 *
 * | grid                         | cell array                |
 * |------------------------------|---------------------------|
 * | float, double (half on disk) | float, double             |
 * | int32, int64                 | int, 64-bit int           |
 * | bool, mask                   | uint8, 0 or 1             |
 * | vec3i, vec3s, vec3d          | int, float, double, 3 each|
 *
 * OpenVDB's voxel index i becomes cell i of the image, which covers [i - 1/2, i + 1/2] in index space. The image's
 * extent starts at the first active voxel and thus need not start at 0. Spacing and origin are in the grid's world
 * units. A rotated grid becomes an image with a direction matrix, or is resampled.
 *
 * The extent is the bounding box of the active voxels of the chosen grids, or the extent that vtkVDBWriter recorded. An
 * inactive cell has the value that the grid defines there: the background, or its negative inside a level set. All
 * chosen grids must share one transform. By default those grids are chosen that share the transform of the first grid
 * that needs no Resample, or if all need it, of the first grid.
 *
 * Field data, from which vtkVDBWriter restores the metadata:
 * `vdb::<key>` the file's metadata; `vdb:<grid>:<key>` a grid's metadata (`class`, `name`, `creator`, ...);
 * `vdb:<grid>:type` the grid's type as in the table; `vdb:<grid>:background` its background value.
 * `g`, `phase_function` and other parameters of a medium's scattering are stored as the file's metadata `medium_g`, ...
 * Metadata of types unknown to OpenVDB are skipped.
 *
 * `active_part`: the fraction of the image's voxels that are active, in the grid with the most active voxels;
 * vtkPhotonMarcher reads from it that a medium is sparse. The image has no mask of active voxels: the mask would be
 * wrong after a filter that changes an array, and solvers find empty voxels from the values in one pass.
 *
 * The files of a series may differ in extent, position and grids: the reader announces the extent of the requested time
 * step to filters downstream. A selected grid that is missing from one of the files is skipped for that file.
 *
 * The grids are listed without loading voxel values, and leaves are loaded only if the requested extent needs them.
 *
 * Errors, each with one message and an empty output: a file that does not exist, is truncated or corrupt (VDBFile.h
 * says what is detected), a grid that does not exist, a transform that an image cannot represent, chosen grids with
 * different transforms, more memory than MaximumMemory. All are detected before the memory is allocated. Versions 222
 * to 224 of the format are supported (OpenVDB 3 to 10).
 *
 * @sa vtkVDBWriter
 */
class TYNDALL_EXPORT vtkVDBReader : public vtkImageAlgorithm
{
public:
  static vtkVDBReader* New();
  vtkTypeMacro(vtkVDBReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Path of the .vdb file, or paths of the files of a series: the first at time 0, the next at time 1, and so on. Each
  /// time step is the image of its file alone, with its own extent; a file without active voxels is an empty image.
  void SetFileName(VTK_FILEPATH const char* fileName); ///< replaces all files by this one; null: no file
  void AddFileName(VTK_FILEPATH const char* fileName);
  void RemoveAllFileNames();
  int GetNumberOfFileNames() const;
  const char* GetFileName(int index = 0); ///< path of the file of this index; null: no such file
  ///@}

  /// Path of the file whose list of grids was read last; empty before the first file.
  const char* GetCurrentFileName();

  /// Whether a file starts like an OpenVDB file.
  virtual int CanReadFile(const char* fileName);

  ///@{
  /// The grids of the file, known after UpdateInformation, and the selection of grids to read. A selected name that is
  /// not in the file is an error.
  int GetNumberOfGridArrays();
  const char* GetGridArrayName(int index);
  int GetGridArrayStatus(const char* name);
  void SetGridArrayStatus(const char* name, int status);
  vtkDataArraySelection* GetGridSelection();
  ///@}

  /// Selects this grid, and deselects all others.
  void SetGridName(const char* name);

  /// Text that lists the grids, one per line: name, type, number of active voxels and their bounding box, memory.
  /// Available after UpdateInformation.
  const char* GetGridSummary();

  ///@{
  /// Whether level sets are converted to fog: 1 inside the surface, decreasing linearly within one voxel of it, 0
  /// outside. A grid of real numbers is a level set if its class says so or, if the class is unknown, if its background
  /// is positive and some values are negative. Default off: values are signed distances.
  tyndallFlagMacro(LevelSetsAsFog);
  ///@}

  ///@{
  /// Whether grids with oblique axes, relative to the world axes or to each other, are resampled to an image along the
  /// world axes that contains their voxels. Its spacing is the shortest edge of a voxel; values are interpolated
  /// linearly between voxel centres (integers: nearest voxel). Default off: a rotated grid becomes an image with a
  /// direction matrix, which solvers handle in its own axes; a sheared grid is an error.
  tyndallFlagMacro(Resample);
  ///@}

  ///@{
  /// Upper limit of the memory for the image and the tree from which it is read, MiB. Default 0: half of the machine's
  /// memory, 90% of the available memory, and, unless vtkVDBWriter recorded an image of that size in the file, 1 GiB or
  /// 1000 times the file's length, whichever is more. The limit protects against corrupt files: one changed bit of a
  /// small file can move a voxel by thousands of voxels.
  tyndallRangeMacro(MaximumMemory, vtkIdType, 0, VTK_ID_MAX >> 20);
  ///@}

  /// Accepts only the reader's own executive, which series of files need. ParaView assigns a new executive to every
  /// source.
  void SetExecutive(vtkExecutive* executive) override;

  /// Modification time of the reader, including that of the grid selection.
  vtkMTimeType GetMTime() override;

protected:
  vtkVDBReader();
  ~vtkVDBReader() override;

  int RequestInformation(vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  vtkExecutive* CreateDefaultExecutive() override;

private:
  vtkVDBReader(const vtkVDBReader&) = delete;
  void operator=(const vtkVDBReader&) = delete;

  class SeriesPipeline;
  int FileAskedFor(vtkInformation* output) const;
  std::array<int, 6> ExtentToRead(vtkInformation* output);
  void ReadGrids(const std::array<int, 6>& extent, vtkImageData* image);

  bool LevelSetsAsFog = false;
  bool Resample = false;
  vtkIdType MaximumMemory = 0;
  vtkNew<vtkDataArraySelection> GridSelection;

  struct Internals;
  std::shared_ptr<Internals> Internal; // empty in a build without OpenVDB
};

#endif
