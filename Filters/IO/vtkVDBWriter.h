#ifndef vtkVDBWriter_h
#define vtkVDBWriter_h

#include "PropertyRange.h"
#include "vtkTyndallModule.h" // for export macro
#include "vtkWriter.h"

class vtkImageData;
class vtkMultiProcessController;

/**
 * @class vtkVDBWriter
 * @brief writes an image as an OpenVDB file (.vdb), a grid for each cell array, a voxel for each cell
 *
 * | cell array                             | grid                                                      |
 * |----------------------------------------|-----------------------------------------------------------|
 * | float, double                          | float, double                                             |
 * | integers of up to 32 bits, of more     | int32, int64 (uint32: int64)                              |
 * | the same with 3 components             | vec3s, vec3d, vec3i                                       |
 * | other numbers of components, 3 x int64 | a grid for each component, `<array>_0`, `<array>_1`, ...  |
 *
 * Of an image of points alone each is a voxel (SetPointData). Beside cell arrays those of points are averaged to cells,
 * where there is no cell array of their name.
 *
 * Cells that equal the background become inactive voxels and take no room; every other one is active. The image's
 * extent, spacing, origin and direction become the grid's index space and transform (see vtkVDBReader: a voxel's index
 * is the cell's), and what a grid cannot say becomes its metadata image_extent_min, image_extent_max, image_cells,
 * image_origin and image_spacing, so that vtkVDBReader gives the image back bit for bit: values (NaN, infinity and -0
 * too), extent, origin, spacing. Where a spacing is below 0 it is written above 0, and the direction of its axis the
 * other way: the same cells at the same places. Of a direction that is not along the axes the last bit may change, and
 * SaveAsHalf and Tolerance change values.
 *
 * Field data `vdb::<key>`, `vdb:<array>:<key>`, `vdb:<array>:type` and `vdb:<array>:background`, as vtkVDBReader makes
 * them, become metadata, type (bool and mask from uint8) and background; field data `g`, `phase_function`,
 * `phase_second_g`, `phase_first_part`, `phase_cosine` and `phase_value`, which belong to a medium, become the file's
 * metadata of the same name after `medium_`, and come back. Other field data are left out. Without them the background
 * is Background, and a grid of one real component with background 0 is a fog volume, any other of unknown class.
 *
 * Cells that vtkGhostType hides are no part of the image: their voxels are inactive. vtkGhostType itself is not
 * written.
 *
 * The file appears whole or not at all: it is written without a name where the file system can do that, else beside its
 * place, read and checked, then put in its place. Of a symbolic link the target is replaced; mode and, where the system
 * allows it, owner of a file that was there stay. Read-only files are not replaced. A hard link keeps the old file.
 *
 * In parallel each rank's piece of the image is gathered on the first rank, array by array, so that one array and all
 * trees have to fit its memory. A cell that several ranks have is taken from the first that does not flag it as a
 * duplicate. Field data are those of the first rank that has cells.
 *
 * Errors, each one message (on every rank), and the file that was there stays: no file name, what is no image (blocks,
 * too: vtkResampleToImage makes one image of them), nothing to write, an unsigned 64-bit integer above 2^63 - 1, a
 * number that 16 bits do not hold where SaveAsHalf is on (names array, voxel, value), a file that cannot be written
 * (names the file and the cause), pieces that are not of one image.
 *
 * @sa vtkVDBReader
 */
class TYNDALL_EXPORT vtkVDBWriter : public vtkWriter
{
public:
  static vtkVDBWriter* New();
  vtkTypeMacro(vtkVDBWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// The .vdb file.
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /// Values of Compression.
  enum Compressions
  {
    NONE = 0,
    ZIP = 1,
    BLOSC = 2
  };

  ///@{
  /// How blocks of values are compressed, without loss. Default BLOSC; where OpenVDB was built without it, ZIP. OpenVDB
  /// does not apply ZIP to fog volumes and level sets.
  tyndallRangeMacro(Compression, int, NONE, BLOSC);
  ///@}

  ///@{
  /// Value of voxels that take no room, in the unit of the array; every component of a vector. Default 0. Field data
  /// `vdb:<array>:background` come first.
  tyndallRangeMacro(Background, double, tyndall::AnyLow, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Values this near to the background become background, and blocks of 8^3 voxels that are this near to their first
  /// one become one value; in the unit of the array. Default 0: nothing is changed. Valid [0, infinity).
  tyndallRangeMacro(Tolerance, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Stores real numbers in 16 bits: 11 significant bits, at most 65504 (65520 and more are an error), and below 6.1e-5
  /// fewer bits: a number that would lose more than 0.1% is an error, the background too. Infinity and NaN are kept.
  /// Default off; off or on, how the file that an image was read from stored its numbers is of no account.
  tyndallFlagMacro(SaveAsHalf);
  ///@}

  ///@{
  /// What arrays of points are where there are none of cells: 0 (default): each is a voxel; 1: their mean is that of
  /// the voxel between them.
  enum PointDataKinds
  {
    VOXELS_AROUND_POINTS = 0,
    AVERAGE_TO_CELLS = 1
  };
  tyndallPointDataMacro();
  ///@}

  /// The image to write.
  vtkImageData* GetImageInput();

  ///@{
  /// Whose ranks have the pieces of the image. At first the global controller; null: this process has the whole image,
  /// and no other takes part.
  virtual void SetController(vtkMultiProcessController* controller);
  vtkGetObjectMacro(Controller, vtkMultiProcessController);
  ///@}

  /// Writes the file. With several ranks all of them have to call it.
  /// @return 1 where the file is written, or else 0: on all ranks the same
  int Write() override;

protected:
  vtkVDBWriter();
  ~vtkVDBWriter() override;

  void WriteData() override;
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int FillInputPortInformation(int port, vtkInformation* info) override;

private:
  vtkVDBWriter(const vtkVDBWriter&) = delete;
  void operator=(const vtkVDBWriter&) = delete;

  char* FileName = nullptr;
  int PointData = VOXELS_AROUND_POINTS;
  int Compression = BLOSC;
  double Background = 0.0;
  double Tolerance = 0.0;
  bool SaveAsHalf = false;
  vtkMultiProcessController* Controller = nullptr;
  bool HasTakenPart = false; ///< in what the ranks do together
};

#endif
