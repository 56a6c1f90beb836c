#ifndef vtkVDBWriter_h
#define vtkVDBWriter_h

#include "PropertyRange.h"
#include "vtkTyndallModule.h" // for export macro
#include "vtkWriter.h"

class vtkImageData;
class vtkMultiProcessController;

/**
 * @class vtkVDBWriter
 * @brief writes an image as an OpenVDB file (.vdb), with one grid per cell array and one voxel per cell
 *
 * | cell array                             | grid                                                      |
 * |----------------------------------------|-----------------------------------------------------------|
 * | float, double                          | float, double                                             |
 * | integers up to 32 bits, above 32 bits  | int32, int64 (uint32: int64)                              |
 * | the same with 3 components             | vec3s, vec3d, vec3i                                       |
 * | other numbers of components, 3 x int64 | a grid for each component, `<array>_0`, `<array>_1`, ...  |
 *
 * If an image has point arrays only, each point becomes a voxel (SetPointData). If it has cell arrays as well, point
 * arrays are averaged to cells, unless a cell array has the same name.
 *
 * Cells that equal the background become inactive voxels, which take no space; all other cells become active voxels.
 * The image's extent, spacing, origin and direction become the grid's index space and transform (a voxel has the index
 * of its cell, see vtkVDBReader). Properties of the image that a transform cannot express are stored as metadata
 * image_extent_min, image_extent_max, image_cells, image_origin and image_spacing, from which vtkVDBReader restores the
 * image bit for bit: values (including NaN, infinity and -0), extent, origin, spacing. A negative spacing is written as
 * a positive one with the opposite direction of its axis, so cells keep their positions. For a direction matrix that is
 * not along the axes the last bit may change; SaveAsHalf and Tolerance change values.
 *
 * Field data `vdb::<key>`, `vdb:<array>:<key>`, `vdb:<array>:type` and `vdb:<array>:background`, as written by
 * vtkVDBReader, become metadata, type (bool and mask from uint8) and background. Field data of a medium, `g`,
 * `phase_function`, `phase_second_g`, `phase_first_part`, `phase_cosine` and `phase_value`, become metadata of the file
 * with the prefix `medium_`, and vtkVDBReader restores them. Other field data are not written. Without field data the
 * background is Background; a grid of one real component with background 0 has the class fog volume, any other grid the
 * class unknown.
 *
 * Cells hidden by vtkGhostType become inactive voxels. vtkGhostType itself is not written.
 *
 * The file is replaced completely or not at all: it is written without a name if the file system supports that,
 * otherwise under a temporary name in the target's folder, then read back, checked, and moved to its target. If the
 * target is a symbolic link, the file that it points to is replaced. An existing file keeps its mode and, if the system
 * allows it, its owner. Read-only files are not replaced. Other hard links keep the old content.
 *
 * In parallel, the pieces of the image are gathered on the first rank, one array at a time; its memory must hold one
 * array and all trees. A cell that several ranks have is taken from the first rank that does not flag it as a
 * duplicate. Field data are taken from the first rank that has cells.
 *
 * Errors, each with one message (on every rank), leave an existing file unchanged: no file name, an input that is not
 * an image (composite data as well: vtkResampleToImage makes one image of them), nothing to write, an unsigned 64-bit
 * integer above 2^63 - 1, a number that does not fit 16 bits if SaveAsHalf is on (names array, voxel, value), a file
 * that cannot be written (names the file and the cause), pieces that do not belong to one image.
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
  /// Path of the .vdb file to write.
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /// Values of the property Compression.
  enum Compressions
  {
    NONE = 0,
    ZIP = 1,
    BLOSC = 2
  };

  ///@{
  /// Lossless compression of blocks of values. Default BLOSC, or ZIP if OpenVDB was built without Blosc. OpenVDB does
  /// not apply ZIP to fog volumes and level sets.
  tyndallRangeMacro(Compression, int, NONE, BLOSC);
  ///@}

  ///@{
  /// Value of inactive voxels, in the unit of the array; the same for every component of a vector. Default 0. Field
  /// data `vdb:<array>:background` take precedence.
  tyndallRangeMacro(Background, double, tyndall::AnyLow, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Values that differ from the background by no more than this become background, and a block of 8^3 voxels whose
  /// values differ from its first value by no more than this becomes one value; in the unit of the array. Default 0: no
  /// value changes. Valid [0, infinity).
  tyndallRangeMacro(Tolerance, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Whether real numbers are stored in 16 bits: 11 significant bits, at most 65504 (65520 and more are an error),
  /// fewer bits below 6.1e-5. A number that would lose more than 0.1% is an error, also if it is the background.
  /// Infinity and NaN are preserved. Default off. The precision of the file from which an image was read has no
  /// influence.
  tyndallFlagMacro(SaveAsHalf);
  ///@}

  ///@{
  /// How point arrays are written if there are no cell arrays. 0 (default): each point is a voxel; 1: voxels are the
  /// cells between points, with the mean of their points.
  tyndallPointDataMacro();
  ///@}

  /// The image to write.
  vtkImageData* GetImageInput();

  ///@{
  /// Controller of the ranks that hold the pieces of the image. Default: the global controller; null: this process has
  /// the complete image and writes it alone.
  virtual void SetController(vtkMultiProcessController* controller);
  vtkGetObjectMacro(Controller, vtkMultiProcessController);
  ///@}

  /// Writes the file. Collective if several ranks hold pieces of the image.
  /// @return 1 if the file was written, 0 otherwise; the same on all ranks
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
  bool HasTakenPart = false; ///< whether this rank has taken part in the collective operations of this write
};

#endif
