#include "TestSupport.h"

#include "vtkDataArray.h"
#include "vtkEnvironmentReader.h"
#include "vtkHDRReader.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtksys/SystemTools.hxx"
#include "vtkTestUtilities.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace
{
std::string Folder;

std::string Path(const std::string& name)
{
  return Folder + "/" + name;
}

std::string ReadBytes(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
}

void WriteBytes(const std::string& path, const std::string& bytes)
{
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

struct Picture
{
  int Width, Height;
  std::vector<float> Rgb; ///< top row first
};

Picture Gradient(int width, int height)
{
  Picture picture{ width, height, {} };
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      picture.Rgb.insert(picture.Rgb.end(), { 1.0f + x, 100.0f * (y + 1), 0.25f });
    }
  }
  return picture;
}

/// @param offset   of the data window in the display window, which is `around` larger on each side
void WriteExr(const std::string& path, const Picture& picture, const std::vector<std::string>& names,
  bool tiled = false, Imf::Compression compression = Imf::ZIP_COMPRESSION, Imath::Box2i display = Imath::Box2i(),
  Imath::V2i offset = { 0, 0 }, Imf::PixelType type = Imf::FLOAT, bool cube = false)
{
  const Imath::Box2i data(offset, offset + Imath::V2i(picture.Width - 1, picture.Height - 1));
  Imf::Header header(display.isEmpty() ? data : display, data);
  header.compression() = compression;
  if (cube)
  {
    Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
  }
  std::vector<half> halves(picture.Rgb.begin(), picture.Rgb.end());
  Imf::FrameBuffer buffer;
  const std::size_t size = type == Imf::FLOAT ? sizeof(float) : sizeof(half);
  const std::size_t pixel = 3 * size, row = pixel * static_cast<std::size_t>(picture.Width);
  char* pixels = type == Imf::FLOAT ? reinterpret_cast<char*>(const_cast<float*>(picture.Rgb.data()))
                                    : reinterpret_cast<char*>(halves.data());
  for (std::size_t channel = 0; channel < names.size(); ++channel)
  {
    header.channels().insert(names[channel], Imf::Channel(type));
    char* base = pixels + size * channel - std::ptrdiff_t(pixel) * offset.x - std::ptrdiff_t(row) * offset.y;
    buffer.insert(names[channel], Imf::Slice(type, base, pixel, row));
  }
  if (tiled)
  {
    header.setTileDescription(Imf::TileDescription(8, 8, Imf::ONE_LEVEL));
    Imf::TiledOutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    return;
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(buffer);
  file.writePixels(picture.Height);
}

/// RGBE of value m 2^(e - 136) with the largest channel's mantissa in [128, 255].
std::string Rgbe(int r, int g, int b, int e)
{
  return { char(r), char(g), char(b), char(e) };
}

/// 16 x 4, each row in new run lengths: red rises, green is constant, exponent 129: values (mantissa + 1/2) / 128.
std::string SmallHdr(const std::string& header = "FORMAT=32-bit_rle_rgbe\n", const std::string& size = "-Y 4 +X 16\n")
{
  std::string bytes = "#?RADIANCE\n# a comment\n" + header + "\n" + size;
  for (int y = 0; y < 4; ++y)
  {
    bytes += { 2, 2, 0, 16, 16 };
    for (int x = 0; x < 16; ++x)
    {
      bytes += char(128 + x + 16 * y);
    }
    bytes += { char(128 + 16), char(64), char(128 + 10), char(32), char(6) };
    bytes += std::string(6, char(32));
    bytes += { char(128 + 16), char(129) };
  }
  return bytes;
}

double Value(vtkImageData* image, int i, int j, int channel)
{
  vtkDataArray* radiance = image->GetPointData()->GetArray("radiance");
  return radiance ? radiance->GetComponent(i + vtkIdType(image->GetDimensions()[0]) * j, channel) : -1e9;
}

bool IsEmpty(vtkImageData* image)
{
  return image->GetNumberOfPoints() == 0 && image->GetPointData()->GetNumberOfArrays() == 0;
}

struct Reading
{
  vtkNew<vtkEnvironmentReader> Reader;
  test::Errors Errors{ Reader };

  vtkImageData* Of(const std::string& path)
  {
    this->Reader->SetFileName(path.c_str());
    this->Reader->Modified();
    this->Reader->Update();
    return this->Reader->GetOutput();
  }
};

void PicturesComeUpright(test::Claims& claims)
{
  Reading reading;
  const Picture picture = Gradient(20, 10);
  for (const bool tiled : { false, true })
  {
    for (const auto type : { Imf::FLOAT, Imf::HALF })
    {
      WriteExr(Path("picture.exr"), picture, { "R", "G", "B" }, tiled, Imf::PIZ_COMPRESSION, {}, { 0, 0 }, type);
      vtkImageData* image = reading.Of(Path("picture.exr"));
      claims.That(reading.Errors.None(), "a whole .exr has no error");
      const int expected[3] = { 20, 10, 1 };
      claims.That(std::equal(expected, expected + 3, image->GetDimensions()), "one point a pixel");
      claims.That(Value(image, 3, 0, 0) == 4.0 && Value(image, 3, 0, 1) == 1000.0 && Value(image, 0, 9, 1) == 100.0,
        "row 0 is the bottom of the picture");
    }
  }
  claims.That(reading.Reader->CanReadFile(Path("picture.exr").c_str()) == 1, "an .exr is known");

  WriteExr(Path("layer.exr"), picture, { "View.Combined.R", "View.Combined.G", "View.Combined.B" });
  claims.That(Value(reading.Of(Path("layer.exr")), 3, 0, 1) == 1000.0, "colours of a layer are found");
  WriteExr(Path("grey.exr"), picture, { "Y" });
  vtkImageData* grey = reading.Of(Path("grey.exr"));
  claims.That(Value(grey, 3, 0, 0) == 4.0 && Value(grey, 3, 0, 2) == 4.0, "luminance alone is grey");

  // The display window is the picture: (-2, -1) to (19, 9); the data window reaches out of it.
  WriteExr(Path("window.exr"), picture, { "R", "G", "B" }, false, Imf::ZIP_COMPRESSION,
    Imath::Box2i(Imath::V2i(-2, -1), Imath::V2i(19, 9)), { 5, 3 });
  vtkImageData* window = reading.Of(Path("window.exr"));
  claims.That(
    window->GetDimensions()[0] == 22 && window->GetDimensions()[1] == 11, "the display window is the picture");
  claims.That(Value(window, 0, 0, 0) == 0.0 && Value(window, 7, 6, 0) == 1.0 && Value(window, 7, 6, 1) == 100.0 &&
      Value(window, 21, 0, 0) == 15.0 && Value(window, 21, 0, 1) == 700.0,
    "the data window lies where it says");

  {
    Imf::RgbaOutputFile file(Path("chroma.exr").c_str(), 16, 8, Imf::WRITE_YC);
    const std::vector<Imf::Rgba> red(16 * 8, Imf::Rgba(2.0f, 1.0f, 0.5f));
    file.setFrameBuffer(red.data(), 1, 16);
    file.writePixels(8);
  }
  vtkImageData* chroma = reading.Of(Path("chroma.exr"));
  claims.Near(Value(chroma, 8, 4, 0), 2.0, 0.01, "red of luminance and chroma");
  claims.Near(Value(chroma, 8, 4, 2), 0.5, 0.01, "blue of luminance and chroma");
  claims.That(reading.Errors.None(), "all of them without an error");
}

void RadianceIsReadInItsUnit(test::Claims& claims)
{
  Reading reading;
  WriteBytes(Path("small.hdr"), SmallHdr());
  vtkImageData* image = reading.Of(Path("small.hdr"));
  claims.That(reading.Errors.None(), "a conservative .hdr has no error");
  claims.That(image->GetDimensions()[0] == 16 && image->GetDimensions()[1] == 4, "its size");
  claims.Near(Value(image, 5, 3, 0), (128 + 5 + 0.5) / 128, 1e-6, "red, top row");
  claims.Near(Value(image, 5, 0, 0), (128 + 5 + 48 + 0.5) / 128, 1e-6, "red, bottom row");
  claims.Near(Value(image, 5, 0, 2), 32.5 / 128, 1e-6, "blue, a run and single pixels");
  WriteBytes(Path("exposed.hdr"), SmallHdr("EXPOSURE=2\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 4.0\n"));
  claims.Near(Value(reading.Of(Path("exposed.hdr")), 5, 3, 0), (133.5) / 128 / 8, 1e-6, "exposures are divided out");
  vtkNew<vtkHDRReader> ofVtk; // where this fails, try whether it serves for .hdr
  test::Errors ofReader(ofVtk);
  ofVtk->SetFileName(Path("exposed.hdr").c_str());
  ofVtk->Update();
  claims.That(!ofReader.None() ||
      ofVtk->GetOutput()->GetPointData()->GetScalars()->GetComponent(5 + 16 * 3, 0) > 1.5 * 133.5 / 128 / 8,
    "VTK's own reader loses all exposures but the last, or refuses the file");
  WriteBytes(Path("turned.hdr"), SmallHdr("FORMAT=32-bit_rle_rgbe\n", "-X 4 +Y 16\n"));
  vtkImageData* turned = reading.Of(Path("turned.hdr"));
  claims.That(turned->GetDimensions()[0] == 4 && turned->GetDimensions()[1] == 16, "a turned picture's size");
  claims.Near(
    Value(turned, 3, 5, 0), (128 + 5 + 0.5) / 128, 1e-6, "a turned picture's first stored row is its right column");
  const std::string old =
    "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n+Y 1 +X 6\n" + Rgbe(200, 100, 50, 128) + Rgbe(1, 1, 1, 4) + Rgbe(10, 20, 30, 0);
  WriteBytes(Path("old.hdr"), old);
  vtkImageData* oldRuns = reading.Of(Path("old.hdr"));
  claims.Near(Value(oldRuns, 4, 0, 0), 200.5 / 256, 1e-6, "old run lengths");
  claims.That(Value(oldRuns, 5, 0, 0) == 0.0, "exponent 0 is black");
  WriteBytes(Path("xyz.hdr"), SmallHdr("FORMAT=32-bit_rle_xyze\n"));
  vtkImageData* xyz = reading.Of(Path("xyz.hdr"));
  claims.That(reading.Errors.WasOneWith("negative"), "a colour outside sRGB is told");
  claims.Near(
    Value(xyz, 0, 3, 0), (3.2404542 * 128.5 - 1.5371385 * 64.5 - 0.4985314 * 32.5) / 128, 1e-5, "XYZ becomes RGB");
}

/// Integral of radiance over the sphere.
double Power(vtkImageData* image, int channel)
{
  const int width = image->GetDimensions()[0], height = image->GetDimensions()[1];
  double power = 0.0;
  for (int j = 0; j < height; ++j)
  {
    const double band = std::cos(vtkMath::Pi() * j / height) - std::cos(vtkMath::Pi() * (j + 1) / height);
    for (int i = 0; i < width; ++i)
    {
      power += Value(image, i, j, channel) * band * 2.0 * vtkMath::Pi() / width;
    }
  }
  return power;
}

void LightIsKept(test::Claims& claims)
{
  Reading reading;
  Picture picture = Gradient(50, 26);
  picture.Rgb[3 * (50 * 7 + 30)] = 1e5f; // a sun
  WriteExr(Path("sun.exr"), picture, { "R", "G", "B" });
  const double power = Power(reading.Of(Path("sun.exr")), 0), green = Power(reading.Of(Path("sun.exr")), 1);
  for (const int width : { 49, 25, 7, 1 })
  {
    reading.Reader->SetWidth(width);
    vtkImageData* small = reading.Of(Path("sun.exr"));
    claims.That(small->GetDimensions()[0] == width, "the width asked for");
    claims.Near(Power(small, 0) / power, 1.0, 1e-5, "red power of a smaller picture over the whole one's");
    claims.Near(Power(small, 1) / green, 1.0, 1e-5, "green power of a smaller picture over the whole one's");
  }
  reading.Reader->SetWidth(1000);
  reading.Reader->SetExposure(3.0);
  vtkImageData* exposed = reading.Of(Path("sun.exr"));
  claims.That(exposed->GetDimensions()[0] == 50, "a picture is never made larger");
  claims.Near(Power(exposed, 0) / power, 8.0, 1e-5, "power three stops up");
  reading.Reader->SetMaximumRadiance(1e4);
  vtkImageData* tamed = reading.Of(Path("sun.exr"));
  claims.Near(Value(tamed, 30, 26 - 1 - 7, 0), 1e4, 1e-2, "the sun is held to the maximum");
  claims.Near(
    Value(tamed, 30, 26 - 1 - 7, 1) / Value(tamed, 30, 26 - 1 - 7, 0), 800.0 / 1e5, 1e-6, "and keeps its hue");
  claims.That(reading.Errors.None(), "all of it without an error");
}

void WrongQuestionsAreErrors(test::Claims& claims)
{
  Reading reading;
  const auto fails = [&](const std::string& path, const char* part, const char* claim) {
    vtkImageData* image = reading.Of(path);
    claims.That(reading.Errors.WasOneWith(part) && IsEmpty(image), claim);
  };
  fails("", "FileName", "no file name is an error");
  WriteBytes(Path("empty.exr"), "");
  WriteBytes(Path("empty.hdr"), "");
  WriteBytes(Path("text.hdr"), "a text that is no picture");
  WriteBytes(Path("text.exr"), "a text that is no picture");
  fails(Path("none.exr"), "cannot be read", "a missing .exr is an error");
  fails(Path("none.hdr"), "cannot be read", "a missing .hdr is an error");
  fails(Path("empty.exr"), "is empty", "an empty .exr is an error");
  fails(Path("empty.hdr"), "is empty", "an empty .hdr is an error");
  fails(Folder, "cannot be read", "a folder is an error");
  fails(Path("text.exr"), "not an OpenEXR file", "a text named .exr is an error");
  fails(Path("text.hdr"), "not a Radiance picture", "a text named .hdr is an error");
  claims.That(!reading.Reader->CanReadFile(Path("text.exr").c_str()), "a text is not taken for a picture");

  Picture picture = Gradient(20, 10);
  WriteExr(Path("depth.exr"), picture, { "Z" });
  fails(Path("depth.exr"), "it has Z", "a picture without colours is an error that names its channels");
  WriteExr(Path("cube.exr"), picture, { "R", "G", "B" }, false, Imf::ZIP_COMPRESSION, {}, { 0, 0 }, Imf::FLOAT, true);
  fails(Path("cube.exr"), "cube map", "a cube map is an error");
  WriteBytes(Path("large.hdr"), SmallHdr("FORMAT=32-bit_rle_rgbe\n", "-Y 100000 +X 100000\n"));
  fails(Path("large.hdr"), "100000 x 100000", "a size that the file cannot hold is an error");

  picture.Rgb[3 * (20 * 2 + 7) + 1] = std::numeric_limits<float>::quiet_NaN();
  WriteExr(Path("nan.exr"), picture, { "R", "G", "B" });
  fails(Path("nan.exr"), "column 7, row 2", "a pixel that is not a number is an error that names it");
  picture.Rgb[3 * (20 * 2 + 7) + 1] = -0.5f;
  picture.Rgb[0] = -1e-3f;
  WriteExr(Path("negative.exr"), picture, { "R", "G", "B" });
  vtkImageData* image = reading.Of(Path("negative.exr"));
  claims.That(
    reading.Errors.WasOneWith("2 values") && Value(image, 7, 7, 1) == 0.0, "negative values become 0, with a warning");
}

/// Damaged files: one error and no data, or other pixels (a warning if they are negative); and always a living
/// application.
void DamagedFilesAreErrors(test::Claims& claims)
{
  Reading reading;
  std::size_t truncations = 0, flips = 0, errorsOfFlips = 0;
  std::mt19937 random(20261121);
  const auto readIt = [&](const std::string& path) {
    vtkImageData* image = reading.Of(path);
    const bool said = !reading.Errors.None();
    const bool one = !said || reading.Errors.WasOneWith("damaged");
    return !one ? -1 : said && IsEmpty(image) ? 1 : 0;
  };
  const auto read = [&](const std::string& path, const std::string& bytes) {
    WriteBytes(path, bytes);
    return readIt(path);
  };
  const auto damage = [&](const std::string& path, const std::string& whole) {
    claims.That(read(path, whole) == 0, "the whole file is read: " + path);
    bool allFound = true, oneError = true;
    for (std::size_t cut = 1; cut <= whole.size(); ++cut, ++truncations)
    {
      allFound = truncate(path.c_str(), static_cast<off_t>(whole.size() - cut)) == 0 && readIt(path) == 1 && allFound;
    }
    for (int seed = 0; seed < 400; ++seed, ++flips)
    {
      std::string bytes = whole;
      for (int count = 1 + static_cast<int>(random() % 4); count > 0; --count)
      {
        bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
      }
      if (seed % 3 == 0)
      {
        bytes[random() % std::min<std::size_t>(bytes.size(), 400)] = static_cast<char>(random());
      }
      const int result = read(path, bytes);
      oneError = oneError && result >= 0;
      errorsOfFlips += result == 1;
    }
    claims.That(allFound, "every truncation is one error and no data: " + path);
    claims.That(oneError, "flipped bits are one error or other pixels: " + path);
  };
  damage(Path("damaged.hdr"), SmallHdr());
  damage(
    Path("damaged.hdr"), "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n+Y 1 +X 6\n" + Rgbe(200, 100, 50, 128) + Rgbe(1, 1, 1, 5));
  const Picture picture = Gradient(17, 9);
  for (const auto compression : { Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,
         Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION })
  {
    WriteExr(Path("damaged.exr"), picture, { "R", "G", "B" }, false, compression, {}, { 0, 0 }, Imf::HALF);
    damage(Path("damaged.exr"), ReadBytes(Path("damaged.exr")));
  }
  WriteExr(Path("damaged.exr"), picture, { "R", "G", "B" }, true);
  damage(Path("damaged.exr"), ReadBytes(Path("damaged.exr")));
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  std::cout << truncations << " truncations, " << flips << " files with flipped bits (" << errorsOfFlips
            << " of them errors), peak memory " << usage.ru_maxrss / 1024 << " MiB\n";
  claims.That(usage.ru_maxrss < 1500L * 1024, "no damaged file makes the reader allocate wildly");
}
}

namespace
{
/// Who opens a pipe waits for someone who writes to it.
void PipesAreErrors(test::Claims& claims)
{
  for (const char* name : { "pipe.exr", "pipe.hdr" })
  {
    const std::string path = Path(name);
    unlink(path.c_str());
    claims.That(mkfifo(path.c_str(), 0600) == 0, "there is a pipe");
    alarm(20); // ends the test where it waits
    vtkNew<vtkEnvironmentReader> reader;
    test::Errors errors(reader);
    claims.That(reader->CanReadFile(path.c_str()) == 0, "a pipe is no environment");
    reader->SetFileName(path.c_str());
    reader->Update();
    alarm(0);
    claims.That(errors.WasOneWith("is not a file but a pipe"), std::string("one error for ") + name);
    unlink(path.c_str());
  }
}
}

int TestEnvironmentReader(int argc, char* argv[])
{
  char* folder = vtkTestUtilities::GetArgOrEnvOrDefault("-T", argc, argv, "TYNDALL_TEST_OUTPUT", ".");
  Folder = std::string(folder) + "/Environment";
  delete[] folder;
  vtksys::SystemTools::MakeDirectory(Folder);

  test::Claims claims;
  PicturesComeUpright(claims);
  RadianceIsReadInItsUnit(claims);
  LightIsKept(claims);
  WrongQuestionsAreErrors(claims);
  DamagedFilesAreErrors(claims);
  PipesAreErrors(claims);
  return claims.Result();
}
