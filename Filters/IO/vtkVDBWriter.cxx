#include "vtkVDBWriter.h"

#include "Common/ImageInput.h"
#include "Common/PrintMembers.h"
#include "Device/Errors.h"
#include "IO/Files.h"
#include "IO/VDB/VDBCells.h"
#include "IO/VDB/VDBFile.h"
#include "IO/VDB/VDBGeometry.h"
#include "IO/VDB/VDBMetadata.h"
#include "Pieces/GatheredImage.h"
#include "Pieces/Ranks.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointDataToCellData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <cerrno>
#include <cstring>
#include <functional>
#include <new>
#include <vector>

namespace
{
/// Makes the grids of one array, with the metadata of the array and the transform of the image.
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

/// Writes the file under a temporary name, and checks it by reading back its structure before it replaces the target.
void WriteWholeOrNot(const std::string& path, const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata,
  std::uint32_t compression)
{
  tyndall::WholeFile whole(path);
  try
  {
    openvdb::io::File file(whole.WorkPath());
    file.setCompression(compression);
    errno = 0;
    file.write(grids, metadata);
    file.close();
    tyndall::VDBFile written(whole.WorkPath());
    for (const tyndall::VDBGrid& grid : written.Grids())
    {
      written.CheckLeaves(grid);
    }
  }
  catch (const std::bad_alloc&)
  {
    throw;
  }
  catch (const std::exception& error)
  {
    whole.Fail(errno != 0 ? std::strerror(errno) : error.what());
  }
  whole.Finish();
}

/// Arrays that become grids: cell arrays, and point arrays averaged to cells unless a cell array has the same name.
std::vector<vtkSmartPointer<vtkDataArray>> CellArraysOf(vtkImageData* image)
{
  std::vector<vtkSmartPointer<vtkDataArray>> arrays;
  const auto add = [&](vtkCellData* of, vtkCellData* before) {
    for (int i = 0; i < of->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* array = of->GetArray(i);
      const char* name = array ? array->GetName() : nullptr;
      const bool isFlags = name && std::strcmp(name, vtkDataSetAttributes::GhostArrayName()) == 0;
      if (array && !isFlags && (before == nullptr || !before->HasArray(name)))
      {
        arrays.emplace_back(array);
      }
    }
  };
  if (image == nullptr || image->GetNumberOfCells() == 0)
  {
    return arrays;
  }
  add(image->GetCellData(), nullptr);
  if (image->GetPointData()->GetNumberOfArrays() > 0)
  {
    vtkNew<vtkPointDataToCellData> average;
    average->SetInputData(image);
    average->Update();
    add(average->GetOutput()->GetCellData(), image->GetCellData());
  }
  return arrays;
}

/// Makes the grids of all arrays of a gathered image on the first rank, and no grids on other ranks. Collective.
/// @param progress  called with the completed fraction
openvdb::GridPtrVec GridsOf(tyndall::GatheredImage& image, vtkMultiProcessController* controller,
  const tyndall::VoxelOptions& options, const std::function<void(double)>& progress)
{
  openvdb::GridPtrVec grids;
  tyndall::VDBPlacement place;
  tyndall::OnAllRanks(controller, [&] {
    if (image.IsFirstRank())
    {
      openvdb::initialize();
      place = tyndall::PlacementOf(image.Frame());
    }
  });
  for (int i = 0; i < image.NumberOfCellArrays(); ++i)
  {
    const vtkSmartPointer<vtkDataArray> array = image.CellArray(i);
    tyndall::OnAllRanks(controller, [&] {
      if (image.IsFirstRank())
      {
        const openvdb::GridPtrVec made = GridsOf(array, image.Frame()->GetFieldData(), place, options);
        grids.insert(grids.end(), made.begin(), made.end());
      }
    });
    progress(static_cast<double>(i + 1) / image.NumberOfCellArrays());
  }
  return grids;
}
}

vtkStandardNewMacro(vtkVDBWriter);

vtkVDBWriter::vtkVDBWriter()
{
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkVDBWriter::~vtkVDBWriter()
{
  this->SetController(nullptr);
  delete[] this->FileName;
}

vtkCxxSetObjectMacro(vtkVDBWriter, Controller, vtkMultiProcessController);

vtkImageData* vtkVDBWriter::GetImageInput()
{
  return vtkImageData::SafeDownCast(this->GetInput());
}

int vtkVDBWriter::FillInputPortInformation(int, vtkInformation* info)
{
  tyndall::TakeOneImage(info);
  tyndall::ReadsVoxels(info, {}, { tyndall::AnyArray });
  return 1;
}

int vtkVDBWriter::Write()
{
  this->HasTakenPart = false;
  const int written = this->Superclass::Write();
  if (!this->HasTakenPart && this->Controller && this->Controller->GetNumberOfProcesses() > 1)
  {
    this->WriteData(); // an error upstream has stopped the pipeline on this rank, but other ranks wait for its piece
    return 0;
  }
  return written;
}

vtkTypeBool vtkVDBWriter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  if (request->Has(Pipeline::REQUEST_UPDATE_EXTENT()) && this->Controller)
  {
    vtkInformation* input = inputs[0]->GetInformationObject(0);
    input->Set(Pipeline::UPDATE_PIECE_NUMBER(), this->Controller->GetLocalProcessId());
    input->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), this->Controller->GetNumberOfProcesses());
    input->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  }
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

void vtkVDBWriter::WriteData()
{
  this->HasTakenPart = true;
  try
  {
    this->SetErrorCode(vtkErrorCode::NoFileNameError);
    tyndall::OnAllRanks(this->Controller, [this] {
      tyndall::CheckProperties(this);
      tyndall::Require(this->FileName != nullptr && this->FileName[0] != '\0', "No file: set FileName.");
    });
    this->SetErrorCode(vtkErrorCode::FileFormatError); // error code that remains if the file is not written
    vtkSmartPointer<vtkImageData> voxels;
    std::vector<vtkSmartPointer<vtkDataArray>> arrays;
    tyndall::OnAllRanks(this->Controller, [&] {
      tyndall::RequireImages(this);
      tyndall::RequireWholeArrays(this);
      voxels = this->GetImageInput();
      if (voxels && tyndall::AreAroundPoints(this, 0, voxels))
      {
        voxels = tyndall::PointsAsVoxels(voxels);
      }
      voxels = voxels ? tyndall::WithSpacingsAbove0(voxels) : voxels;
      arrays = CellArraysOf(voxels);
    });
    tyndall::GatheredImage image(
      this->Controller, voxels, arrays, {}, tyndall::GatheredImage::On::FirstRank, "The image is not written");
    tyndall::OnAllRanks(this->Controller, [&] {
      tyndall::Require(!image.IsFirstRank() || (image.Frame() != nullptr && image.NumberOfCellArrays() != 0),
        "\"" + std::string(this->FileName) + "\" is not written: the image has no " +
          (image.Frame() ? "arrays." : "cells."));
    });
    const tyndall::VoxelOptions options{ this->Background, this->Tolerance, this->SaveAsHalf, image.HiddenCells() };
    const openvdb::GridPtrVec grids =
      GridsOf(image, this->Controller, options, [this](double done) { this->UpdateProgress(0.5 * done); });
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError);
    tyndall::OnAllRanks(this->Controller, [&] {
      if (image.IsFirstRank())
      {
        openvdb::MetaMap metadata;
        tyndall::RestoreMetadata(metadata, image.Frame()->GetFieldData(), tyndall::FieldName("", ""));
        tyndall::NoteMediumFacts(metadata, image.Frame()->GetFieldData());
        WriteWholeOrNot(this->FileName, grids, metadata, CompressionFlags(this->Compression));
      }
    });
    this->SetErrorCode(vtkErrorCode::NoError);
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
  tyndallPrintMacro(PointData, Compression, Background, Tolerance);
  os << indent << "SaveAsHalf: " << (this->SaveAsHalf ? "on" : "off") << "\n";
}
