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
 * Output: vtkImageData with a cell array for each chosen grid, named after it.
 *
 * | grid                         | cell array                |
 * |------------------------------|---------------------------|
 * | float, double (half on disk) | float, double             |
 * | int32, int64                 | int, 64-bit int           |
 * | bool, mask                   | uint8, 0 or 1             |
 * | vec3i, vec3s, vec3d          | int, float, double, 3 each|
 *
 * A cell is centred on its voxel's index: index i of OpenVDB is the cell that covers [i - 1/2, i + 1/2] in index space,
 * and cell i of the image, whose extent starts at the first active voxel and so need not start at 0. Units: spacing
 * and origin are the grid's world units. A rotated grid becomes an image with a direction matrix, or
 * is resampled.
 *
 * The extent is the box of the active voxels of the chosen grids, or the extent that vtkVDBWriter noted. A cell that is
 * not active has the value that the grid gives it: the background, or inside a level set its negative.
 * Chosen grids must share one transform: at first those that share that of the first grid that needs no Resample, or
 * where all need it, of the first.
 *
 * Field data, from which vtkVDBWriter restores them:
 * `vdb::<key>` the file's metadata; `vdb:<grid>:<key>` a grid's (`class`, `name`, `creator`, ...);
 * `vdb:<grid>:type` the grid's type as in the table; `vdb:<grid>:background` its background value.
 * `g`, `phase_function` and what else says how a medium scatters are the file's metadata `medium_g`, ... Metadata of
 * types that OpenVDB does not know are left out.
 *
 * `active_part` the part of the whole image's voxels that are active, of the grid that has most: by it vtkPhotonMarcher
 * knows that a medium is sparse. No mask of what is active goes with the image: it would be wrong after a filter that
 * changes an array, and solvers find what is empty from the values in one pass.
 *
 * Files of a series may have other extents, places and grids than each other: filters after the reader are told of the
 * extent of the time that is asked for. A grid that is switched on and is not in one of the files is left out there.
 *
 * The file is listed without loading a voxel value, and leaves are loaded where the requested extent needs them only.
 *
 * Errors, each one message, with empty output: a file that is not there, truncated or corrupt (see VDBFile.h for what
 * is noticed), a grid that is not there, a transform that no image has, chosen grids on different transforms, more
 * memory than MaximumMemory; all of them before the memory is taken. Versions 222 to 224 of the format are read
 * (OpenVDB 3 to 10).
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
  /// The .vdb file, or those of a series: the first at time 0, the next at time 1, and so on. Each time's image is what
  /// its file alone gives, with an extent of its own; a file without active voxels is an empty image.
  void SetFileName(VTK_FILEPATH const char* fileName); ///< instead of all others; null: none
  void AddFileName(VTK_FILEPATH const char* fileName);
  void RemoveAllFileNames();
  int GetNumberOfFileNames() const;
  const char* GetFileName(int index = 0); ///< null: there is none
  ///@}

  /// The file that was looked at last.
  const char* GetCurrentFileName();

  /// Whether the file begins as an OpenVDB file does.
  virtual int CanReadFile(const char* fileName);

  ///@{
  /// The grids of the file, known after UpdateInformation, and which of them to read. A name that is switched on and is
  /// not in the file is an error.
  int GetNumberOfGridArrays();
  const char* GetGridArrayName(int index);
  int GetGridArrayStatus(const char* name);
  void SetGridArrayStatus(const char* name, int status);
  vtkDataArraySelection* GetGridSelection();
  ///@}

  /// Reads this grid and no other.
  void SetGridName(const char* name);

  /// The grids, a line each: name, type, active voxels and their box, memory. After UpdateInformation.
  const char* GetGridSummary();

  ///@{
  /// Whether level sets (grids of real numbers whose class says so, or whose class is not known, with a positive
  /// background and values below 0) become fog: 1 inside of the surface, less in proportion within a voxel of it, 0
  /// outside. Default off: the distances, as they are.
  tyndallFlagMacro(LevelSetsAsFog);
  ///@}

  ///@{
  /// Whether grids whose axes go aslant to those of the world, or are not at right angles to each other, are resampled
  /// to an image along the world's axes, which holds their voxels: with the shortest edge of a voxel, linear between
  /// the middles of voxels (integers: the nearest). Default off: aslant ones have a direction matrix, and are solved in
  /// their own axes; those that shear are an error.
  tyndallFlagMacro(Resample);
  ///@}

  ///@{
  /// Most memory that the image and the tree it is read from may take, MiB. Default 0: half of the machine's memory,
  /// 90% of what is available, and, unless vtkVDBWriter noted that the file was an image of that size, 1 GiB or 1000
  /// times the file's length, whichever is more: one changed bit of a small file can put a voxel thousands of voxels
  /// away.
  tyndallRangeMacro(MaximumMemory, vtkIdType, 0, VTK_ID_MAX >> 20);
  ///@}

  /// Stays with the reader's own, which a series needs: ParaView gives every source another one.
  void SetExecutive(vtkExecutive* executive) override;

  /// Later than the selection of grids, too.
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
  std::unique_ptr<Internals> Internal;
};

#endif
