// vtkVDBReader and vtkVDBWriter of a build without OpenVDB (TYNDALL_WITH_OPENVDB off): both fail with one error.
#include "Device/Errors.h"
#include "Pieces/GuardedWork.h"
#include "vtkVDBReader.h"
#include "vtkVDBWriter.h"

#include "vtkDataArraySelection.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"

namespace
{
const char* const NoOpenVDB =
  "This build of Tyndall has no OpenVDB (TYNDALL_WITH_OPENVDB is off), so it neither reads "
  "nor writes .vdb: build it with OpenVDB 10 or newer, or use another format, such as .vti.";
}

vtkStandardNewMacro(vtkVDBReader);

vtkVDBReader::vtkVDBReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkVDBReader::~vtkVDBReader() = default;

void vtkVDBReader::SetFileName(const char* fileName)
{
  this->RemoveAllFileNames();
  this->AddFileName(fileName);
}

void vtkVDBReader::AddFileName(const char*)
{
  this->Modified();
}

void vtkVDBReader::RemoveAllFileNames()
{
  this->Modified();
}

int vtkVDBReader::GetNumberOfFileNames() const
{
  return 0;
}

const char* vtkVDBReader::GetFileName(int)
{
  return nullptr;
}

const char* vtkVDBReader::GetCurrentFileName()
{
  return "";
}

/// Accepts any file, so that opening a .vdb file reports the error.
int vtkVDBReader::CanReadFile(const char* fileName)
{
  return fileName != nullptr;
}

int vtkVDBReader::GetNumberOfGridArrays()
{
  return 0;
}

const char* vtkVDBReader::GetGridArrayName(int)
{
  return nullptr;
}

int vtkVDBReader::GetGridArrayStatus(const char*)
{
  return 0;
}

void vtkVDBReader::SetGridArrayStatus(const char*, int) {}

vtkDataArraySelection* vtkVDBReader::GetGridSelection()
{
  return this->GridSelection;
}

void vtkVDBReader::SetGridName(const char*) {}

const char* vtkVDBReader::GetGridSummary()
{
  return "";
}

vtkMTimeType vtkVDBReader::GetMTime()
{
  return this->Superclass::GetMTime();
}

vtkExecutive* vtkVDBReader::CreateDefaultExecutive()
{
  return this->Superclass::CreateDefaultExecutive();
}

void vtkVDBReader::SetExecutive(vtkExecutive* executive)
{
  this->Superclass::SetExecutive(executive);
}

int vtkVDBReader::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*)
{
  tyndall::GuardedInformation(this, [] { throw tyndall::InvalidInput(NoOpenVDB); });
  return 1;
}

int vtkVDBReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  return tyndall::Guarded(this, outputs, [] { throw tyndall::InvalidInput(NoOpenVDB); });
}

void vtkVDBReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

vtkStandardNewMacro(vtkVDBWriter);

vtkVDBWriter::vtkVDBWriter() = default;

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
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkVDBWriter::Write()
{
  this->WriteData();
  return 0;
}

vtkTypeBool vtkVDBWriter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

void vtkVDBWriter::WriteData()
{
  this->SetErrorCode(vtkErrorCode::FileFormatError);
  vtkErrorMacro(<< NoOpenVDB);
}

void vtkVDBWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
