#ifndef vtkVDBWriter_h
#define vtkVDBWriter_h

#include "PropertyRange.h"
#include "vtkTyndallModule.h" // for export macro
#include "vtkWriter.h"

class vtkImageData;

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
 * Point arrays are averaged to cells, where there is no cell array of their name.
 *
 * Cells that equal the background become inactive voxels and take no room; every other one is active. The image's extent,
 * spacing, origin and direction become the grid's index space and transform (see vtkVDBReader: a voxel's index is the
 * cell's), and what a grid cannot say becomes its metadata image_extent_min, image_extent_max, image_origin and image_spacing,
 * so that vtkVDBReader gives the image back bit for bit: values (NaN, infinity and -0 too), extent, origin, spacing. Of a
 * direction that is not along the axes the last bit may change, and SaveAsHalf and Tolerance change values.
 *
 * Field data `vdb::<key>`, `vdb:<array>:<key>`, `vdb:<array>:type` and `vdb:<array>:background`, as vtkVDBReader makes
 * them, become metadata, type (bool and mask from uint8) and background; field data `g`, which belong to a medium, become
 * the file's metadata `medium_g`, and come back as `g`. Other field data are left out. Without them the background is Background, and
 * a grid of one real component with background 0 is a fog volume, any other of unknown class.
 *
 * The file appears whole or not at all: it is written beside its place, read and checked, then renamed.
 *
 * Errors, each one message: no file name, nothing to write, an unsigned 64-bit integer above 2^63 - 1, a file that cannot
 * be written (names the folder and the cause).
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
  tyndallSetRangeMacro(Compression, int, NONE, BLOSC);
  vtkGetMacro(Compression, int);
  ///@}

  ///@{
  /// Value of voxels that take no room, in the unit of the array; every component of a vector. Default 0. Field data
  /// `vdb:<array>:background` come first.
  tyndallSetRangeMacro(Background, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetMacro(Background, double);
  ///@}

  ///@{
  /// Values this near to the background become background, and blocks of 8^3 voxels that are this near to their first one
  /// become one value; in the unit of the array. Default 0: nothing is changed. Valid [0, infinity).
  tyndallSetRangeMacro(Tolerance, double, 0.0, tyndall::AnyHigh);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /// Stores real numbers in 16 bits: 11 significant bits, at most 65504. Default off.
  vtkSetMacro(SaveAsHalf, bool);
  vtkGetMacro(SaveAsHalf, bool);
  vtkBooleanMacro(SaveAsHalf, bool);
  ///@}

  /// The image to write.
  vtkImageData* GetImageInput();

protected:
  vtkVDBWriter() = default;
  ~vtkVDBWriter() override;

  void WriteData() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;

private:
  vtkVDBWriter(const vtkVDBWriter&) = delete;
  void operator=(const vtkVDBWriter&) = delete;

  char* FileName = nullptr;
  int Compression = BLOSC;
  double Background = 0.0;
  double Tolerance = 0.0;
  bool SaveAsHalf = false;
};

#endif
