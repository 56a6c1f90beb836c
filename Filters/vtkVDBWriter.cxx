#include "vtkVDBWriter.h"

#include "Device/Errors.h"
#include "VDBCells.h"
#include "VDBFile.h"
#include "VDBGeometry.h"
#include "VDBMetadata.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointDataToCellData.h"
#include "vtkSmartPointer.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <unistd.h>

using tyndall::InvalidInput;

namespace
{
/// The grids of one array, with its metadata, where the image is.
openvdb::GridPtrVec GridsOf(
  vtkDataArray* array, vtkFieldData* field, const tyndall::VDBPlacement& place, const tyndall::VoxelOptions& options)
{
  const std::string name = array->GetName() ? array->GetName() : "";
  openvdb::GridPtrVec grids = tyndall::MakeGrids(array, field, place.Voxels, options);
  for (const openvdb::GridBase::Ptr& grid : grids)
  {
    grid->setCreator("Tyndall");
    tyndall::RestoreMetadata(*grid, field, tyndall::FieldName(name, ""));
    grid->setTransform(place.Transform->copy());
    grid->insertMeta(place.Notes);
  }
  return grids;
}

std::uint32_t CompressionFlags(int compression)
{
  using namespace openvdb::io;
  std::uint32_t flags = COMPRESS_ACTIVE_MASK;
  if (compression == vtkVDBWriter::BLOSC && Archive::hasBloscCompression())
  {
    flags |= COMPRESS_BLOSC;
  }
  else if (compression != vtkVDBWriter::NONE)
  {
    flags |= COMPRESS_ZIP;
  }
  return flags;
}

/// Writes beside the file's place, reads that back as far as its structure goes, and renames it.
void WriteWholeOrNot(const std::string& path, const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata,
  std::uint32_t compression)
{
  const std::string partial = path + ".partial-" + std::to_string(getpid());
  const auto fail = [&](const std::string& why) {
    std::remove(partial.c_str());
    throw InvalidInput("\"" + path + "\" cannot be written: " + why +
      ". Check that its folder is there, may be written to and has room.");
  };
  try
  {
    openvdb::io::File file(partial);
    file.setCompression(compression);
    errno = 0;
    file.write(grids, metadata);
    file.close();
    tyndall::VDBFile written(partial);
    for (const tyndall::VDBGrid& grid : written.Grids())
    {
      written.CheckLeaves(grid);
    }
  }
  catch (const std::exception& error)
  {
    fail(errno != 0 ? std::strerror(errno) : error.what());
  }
  if (std::rename(partial.c_str(), path.c_str()) != 0)
  {
    fail(std::strerror(errno));
  }
}
}

vtkStandardNewMacro(vtkVDBWriter);

vtkVDBWriter::~vtkVDBWriter()
{
  delete[] this->FileName;
}

vtkImageData* vtkVDBWriter::GetImageInput()
{
  return vtkImageData::SafeDownCast(this->GetInput());
}

int vtkVDBWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

void vtkVDBWriter::WriteData()
{
  try
  {
    tyndall::CheckProperties(this);
    if (this->FileName == nullptr || this->FileName[0] == '\0')
    {
      this->SetErrorCode(vtkErrorCode::NoFileNameError);
      throw InvalidInput("No file: set FileName.");
    }
    this->SetErrorCode(vtkErrorCode::FileFormatError); // until it is written
    vtkImageData* image = this->GetImageInput();
    if (image == nullptr || image->GetNumberOfCells() == 0)
    {
      throw InvalidInput("\"" + std::string(this->FileName) + "\" is not written: the image has no cells.");
    }
    vtkSmartPointer<vtkImageData> cells = image;
    if (image->GetPointData()->GetNumberOfArrays() > 0)
    {
      vtkNew<vtkPointDataToCellData> average;
      average->SetInputData(image);
      average->Update();
      cells = vtkImageData::SafeDownCast(average->GetOutput());
    }

    openvdb::initialize();
    const tyndall::VDBPlacement place = tyndall::PlacementOf(image);
    const tyndall::VoxelOptions options{ this->Background, this->Tolerance, this->SaveAsHalf };
    vtkFieldData* field = image->GetFieldData();
    openvdb::GridPtrVec grids;
    const auto addAll = [&](vtkFieldData* arrays, const vtkFieldData* before) {
      for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
      {
        vtkDataArray* array = vtkDataArray::SafeDownCast(arrays->GetAbstractArray(i));
        if (array && (before == nullptr || !const_cast<vtkFieldData*>(before)->HasArray(array->GetName())))
        {
          const openvdb::GridPtrVec made = GridsOf(array, field, place, options);
          grids.insert(grids.end(), made.begin(), made.end());
          this->UpdateProgress(0.5 * (i + 1) / arrays->GetNumberOfArrays());
        }
      }
    };
    addAll(image->GetCellData(), nullptr);
    if (cells != image)
    {
      addAll(cells->GetCellData(), image->GetCellData());
    }
    if (grids.empty())
    {
      throw InvalidInput("\"" + std::string(this->FileName) + "\" is not written: the image has no arrays.");
    }
    openvdb::MetaMap metadata;
    tyndall::RestoreMetadata(metadata, field, tyndall::FieldName("", ""));
    tyndall::NoteMediumFacts(metadata, field);
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError);
    WriteWholeOrNot(this->FileName, grids, metadata, CompressionFlags(this->Compression));
    this->SetErrorCode(vtkErrorCode::NoError);
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("The machine's memory does not suffice to write the image as a tree. Write fewer arrays at a time.");
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

void vtkVDBWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "Compression: " << this->Compression << "\n";
  os << indent << "Background: " << this->Background << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "SaveAsHalf: " << (this->SaveAsHalf ? "on" : "off") << "\n";
}
