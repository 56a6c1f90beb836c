#include "IO/RadianceFile.h"

#include "Device/Errors.h"
#include "IO/Files.h"
#include "Numerics/NumberText.h"

#ifdef TYNDALL_HAS_OPENEXR
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <openexr.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace tyndall
{
namespace
{
/// Upper bound of the number of pixels that one byte of a file can encode, with a wide margin: large compressed blocks
/// of black pixels need the fewest bytes.
constexpr std::uint64_t MostPixelsAByte = 20000;
constexpr std::int64_t LongestEdge = 1 << 17;

[[noreturn]] void Corrupt(const std::string& path, const std::string& why)
{
  throw InvalidInput("\"" + path + "\" is truncated or corrupt: " + why + ". Copy or write the file again.");
}

std::vector<unsigned char> ReadBytes(const std::string& path, std::uint64_t most)
{
  const std::uint64_t size = ReadableSize(path);
  Require(size != 0, "\"" + path + "\" is empty. Copy or write the file again.");
  std::ifstream stream(path, std::ios::binary);
  std::vector<unsigned char> bytes(std::min(size, most));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  Require(!stream.fail(), "\"" + path + "\" cannot be read to its end. Check the disk and the file's permissions.");
  return bytes;
}

void CheckSize(const std::string& path, std::int64_t width, std::int64_t height, std::uint64_t fileSize)
{
  if (width < 1 || height < 1 || width > LongestEdge || height > LongestEdge ||
    static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > fileSize * MostPixelsAByte)
  {
    Corrupt(path,
      "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels cannot be in a file of " +
        std::to_string(fileSize) + " bytes");
  }
}

//
// Radiance files (.hdr, .pic)
//

struct HdrHeader
{
  int Width = 0, Height = 0; ///< size of the displayed picture, pixels
  int Rows = 0, Columns = 0; ///< numbers of stored rows, and of pixels per row
  bool Transposed = false;   ///< whether each stored row is a column of the picture
  bool FromTop = true;       ///< whether Y decreases along the file: from the top to the bottom of the picture
  bool FromLeft = true;      ///< whether X increases along the file: from the left to the right of the picture
  bool Xyz = false;
  double Exposure = 1.0;  ///< product of the EXPOSURE lines, by which the stored radiance was multiplied
  std::size_t Pixels = 0; ///< offset of the pixel data in the file, bytes
};

constexpr std::size_t LongestHdrHeader = 1 << 16;

/// Reads the lines of a Radiance file's header one by one.
class HdrLines
{
public:
  HdrLines(const std::string& path, const std::vector<unsigned char>& bytes)
    : Path(path)
    , Bytes(bytes)
  {
  }

  std::string Next()
  {
    const auto begin = this->Bytes.begin() + static_cast<std::ptrdiff_t>(this->Place);
    const auto end = std::find(begin, this->Bytes.end(), '\n');
    if (end == this->Bytes.end() || this->Place > LongestHdrHeader)
    {
      Corrupt(this->Path, "its header does not end");
    }
    std::string text(begin, end);
    this->Place = static_cast<std::size_t>(end - this->Bytes.begin()) + 1;
    if (!text.empty() && text.back() == '\r')
    {
      text.pop_back();
    }
    return text;
  }

  std::size_t At() const { return this->Place; } ///< offset of the next line in the file, bytes

private:
  const std::string& Path;
  const std::vector<unsigned char>& Bytes;
  std::size_t Place = 0;
};

void ParseHdrFormat(const std::string& path, const std::string& format, HdrHeader& header)
{
  header.Xyz = format.find("32-bit_rle_xyze") != std::string::npos;
  if (!header.Xyz && format.find("32-bit_rle_rgbe") == std::string::npos)
  {
    Corrupt(path, "its format is \"" + format + "\", not 32-bit_rle_rgbe or 32-bit_rle_xyze");
  }
}

double ParseHdrExposure(const std::string& path, const std::string& text)
{
  const double exposure = NumberIn(text).value_or(0.0);
  if (!(exposure > 0.0) || !std::isfinite(exposure))
  {
    Corrupt(path, "its exposure is \"" + text + "\", not a positive number");
  }
  return exposure;
}

/// Parses the line of the header that states the picture's size and the order of its rows, e.g. "-Y 512 +X 1024".
void ParseHdrSize(const std::string& path, const std::string& size, HdrHeader& header)
{
  char signs[2] = {}, axes[2] = {};
  int lengths[2] = {}, used = 0;
  const int found = std::sscanf(
    size.c_str(), "%c%c %6d %c%c %6d%n", &signs[0], &axes[0], &lengths[0], &signs[1], &axes[1], &lengths[1], &used);
  const auto isSign = [](char c) { return c == '+' || c == '-'; };
  const bool xFirst = axes[0] == 'X' && axes[1] == 'Y';
  if (found != 6 || used != static_cast<int>(size.size()) || !isSign(signs[0]) || !isSign(signs[1]) ||
    !(xFirst || (axes[0] == 'Y' && axes[1] == 'X')))
  {
    Corrupt(path, "its size is \"" + size.substr(0, 40) + "\", not like \"-Y 512 +X 1024\"");
  }
  header.Transposed = xFirst;
  header.Rows = lengths[0];
  header.Columns = lengths[1];
  header.Width = xFirst ? lengths[0] : lengths[1];
  header.Height = xFirst ? lengths[1] : lengths[0];
  header.FromTop = signs[xFirst ? 1 : 0] == '-';
  header.FromLeft = signs[xFirst ? 0 : 1] == '+';
}

HdrHeader ParseHdrHeader(const std::string& path, const std::vector<unsigned char>& bytes)
{
  Require(bytes.size() >= 2 && bytes[0] == '#' && bytes[1] == '?',
    "\"" + path + "\" is not a Radiance picture: it does not begin with #?.");
  HdrHeader header;
  HdrLines lines(path, bytes);
  lines.Next();
  bool hasFormat = false;
  for (std::string text = lines.Next(); !text.empty(); text = lines.Next())
  {
    if (text.compare(0, 7, "FORMAT=") == 0)
    {
      ParseHdrFormat(path, text.substr(7), header);
      hasFormat = true;
    }
    else if (text.compare(0, 9, "EXPOSURE=") == 0)
    {
      header.Exposure *= ParseHdrExposure(path, text.substr(9));
    }
  }
  if (!hasFormat)
  {
    Corrupt(path, "its header has no FORMAT line");
  }
  ParseHdrSize(path, lines.Next(), header);
  header.Pixels = lines.At();
  return header;
}

/// Decodes the rows of a picture without reading beyond the file or writing beyond the row.
class HdrRows
{
public:
  HdrRows(const std::string& path, const std::vector<unsigned char>& bytes, const HdrHeader& header)
    : Path(path)
    , Bytes(bytes)
    , Columns(static_cast<std::size_t>(header.Columns))
    , At(header.Pixels)
  {
  }

  /// Decodes the next row.
  /// @param rgbe  receives the row: red, green, blue and exponent of each of Columns pixels
  void Next(std::vector<unsigned char>& rgbe)
  {
    ++this->Row;
    unsigned char start[4];
    this->Take(start, 4);
    const bool runs = this->Columns >= 8 && this->Columns < 0x8000 && start[0] == 2 && start[1] == 2 && start[2] < 0x80;
    if (!runs)
    {
      this->OldRow(start, rgbe);
      return;
    }
    if (static_cast<std::size_t>(start[2] * 256 + start[3]) != this->Columns)
    {
      this->Fail("has another length than the picture");
    }
    for (std::size_t channel = 0; channel < 4; ++channel)
    {
      for (std::size_t x = 0; x < this->Columns;)
      {
        const unsigned char code = this->Take();
        const std::size_t count = code > 128 ? code - 128u : code;
        if (count == 0 || count > this->Columns - x)
        {
          this->Fail("has a run that does not fit");
        }
        const unsigned char repeated = code > 128 ? this->Take() : 0;
        for (const std::size_t end = x + count; x < end; ++x)
        {
          rgbe[4 * x + channel] = code > 128 ? repeated : this->Take();
        }
      }
    }
  }

private:
  /// Decodes a row of pixels in the old run-length encoding: the code (1, 1, 1, n) repeats the last pixel n times, and
  /// n is shifted left by 8 bits for each such code directly before it.
  void OldRow(const unsigned char* start, std::vector<unsigned char>& rgbe)
  {
    unsigned char pixel[4];
    std::memcpy(pixel, start, 4);
    int shift = 0;
    for (std::size_t x = 0; x < this->Columns;)
    {
      if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1)
      {
        const std::size_t count = shift < 24 ? static_cast<std::size_t>(pixel[3]) << shift : SIZE_MAX;
        if (x == 0 || count > this->Columns - x)
        {
          this->Fail("has a run that does not fit");
        }
        for (const std::size_t end = x + count; x < end; ++x)
        {
          std::memcpy(&rgbe[4 * x], &rgbe[4 * x - 4], 4);
        }
        shift += 8;
      }
      else
      {
        std::memcpy(&rgbe[4 * x], pixel, 4);
        ++x;
        shift = 0;
      }
      if (x < this->Columns)
      {
        this->Take(pixel, 4);
      }
    }
  }

  unsigned char Take()
  {
    unsigned char byte;
    this->Take(&byte, 1);
    return byte;
  }

  void Take(unsigned char* target, std::size_t count)
  {
    if (count > this->Bytes.size() - this->At)
    {
      this->Fail("ends with the file");
    }
    std::memcpy(target, this->Bytes.data() + this->At, count);
    this->At += count;
  }

  [[noreturn]] void Fail(const char* why) const
  {
    Corrupt(
      this->Path, "stored row " + std::to_string(this->Row) + " " + why + " (byte " + std::to_string(this->At) + ")");
  }

  const std::string& Path;
  const std::vector<unsigned char>& Bytes;
  std::size_t Columns;
  std::size_t At;
  int Row = -1;
};

void XyzToRgb(float* pixel)
{
  const float x = pixel[0], y = pixel[1], z = pixel[2];
  pixel[0] = 3.2404542f * x - 1.5371385f * y - 0.4985314f * z; // XYZ to linear sRGB, IEC 61966-2-1, D65
  pixel[1] = -0.9692660f * x + 1.8760108f * y + 0.0415560f * z;
  pixel[2] = 0.0556434f * x - 0.2040259f * y + 1.0572252f * z;
}

//
// OpenEXR files (.exr)
//
#ifdef TYNDALL_HAS_OPENEXR

/// Data and display window of the first part of an OpenEXR file, read by OpenEXR's C interface, which accepts a limit
/// for the picture's size.
struct ExrWindows
{
  exr_attr_box2i_t Data, Display;
};

ExrWindows WindowsOfExr(const std::string& path)
{
  const std::vector<unsigned char> start = ReadBytes(path, 4);
  const unsigned char magic[4] = { 0x76, 0x2f, 0x31, 0x01 };
  Require(start.size() >= 4 && std::memcmp(start.data(), magic, 4) == 0,
    "\"" + path + "\" is not an OpenEXR file: it does not begin as one.");
  exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
  settings.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
  settings.max_image_width = LongestEdge;
  settings.max_image_height = LongestEdge;
  settings.max_tile_width = LongestEdge;
  settings.max_tile_height = LongestEdge;
  exr_context_t context = nullptr;
  const exr_result_t opened = exr_start_read(&context, path.c_str(), &settings);
  if (opened != EXR_ERR_SUCCESS)
  {
    exr_finish(&context);
    Corrupt(path, std::string("its header says ") + exr_get_error_code_as_string(opened));
  }
  ExrWindows windows{};
  exr_storage_t storage = EXR_STORAGE_SCANLINE;
  const bool found = exr_get_data_window(context, 0, &windows.Data) == EXR_ERR_SUCCESS &&
    exr_get_display_window(context, 0, &windows.Display) == EXR_ERR_SUCCESS &&
    exr_get_storage(context, 0, &storage) == EXR_ERR_SUCCESS;
  std::int32_t tile[4] = { 1, 1, 0, 0 };
  if (found && storage == EXR_STORAGE_TILED)
  {
    exr_tile_level_mode_t level;
    exr_tile_round_mode_t rounding;
    std::uint32_t width = 1, height = 1;
    exr_get_tile_descriptor(context, 0, &width, &height, &level, &rounding);
    tile[0] = static_cast<std::int32_t>(width);
    tile[1] = static_cast<std::int32_t>(height);
  }
  exr_finish(&context);
  if (!found)
  {
    Corrupt(path, "it has no data window or display window");
  }
  Require(storage != EXR_STORAGE_DEEP_SCANLINE && storage != EXR_STORAGE_DEEP_TILED,
    "\"" + path + "\" is a deep picture. Flatten it first.");
  const std::uint64_t size = ReadableSize(path);
  for (const exr_attr_box2i_t& window : { windows.Data, windows.Display })
  {
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
    const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
    CheckSize(path, width, height, size);
  }
  CheckSize(path, tile[0], tile[1], size);
  return windows;
}

/// Names of the channels of an OpenEXR file that hold the colours of the picture.
struct ExrChannels
{
  std::string Names[3]; ///< red, green, blue; the same channel three times if the picture is grey
  bool Chroma = false;  ///< whether the channels are Y, RY, BY, which OpenEXR converts to RGB
};

ExrChannels FindChannels(const std::string& path, const Imf::ChannelList& list)
{
  const auto usable = [&](const std::string& name) {
    const Imf::Channel* channel = list.findChannel(name.c_str());
    return channel && channel->xSampling == 1 && channel->ySampling == 1;
  };
  std::string all;
  for (auto channel = list.begin(); channel != list.end(); ++channel)
  {
    const std::string name = channel.name();
    all += (all.empty() ? "" : ", ") + name;
  }
  const auto colours = [&](const std::string& layer) {
    return usable(layer + "R") && usable(layer + "G") && usable(layer + "B");
  };
  if (colours(""))
  {
    return { { "R", "G", "B" }, false };
  }
  for (auto channel = list.begin(); channel != list.end(); ++channel)
  {
    const std::string name = channel.name();
    const std::string layer = name.substr(0, name.size() - 1);
    if (name.size() > 2 && name.compare(name.size() - 2, 2, ".R") == 0 && colours(layer))
    {
      return { { layer + "R", layer + "G", layer + "B" }, false };
    }
  }
  if (usable("Y"))
  {
    const bool chroma = list.findChannel("RY") && list.findChannel("BY");
    return { { "Y", "Y", "Y" }, chroma };
  }
  throw InvalidInput(
    "\"" + path + "\" has neither the channels R, G, B nor Y; it has " + (all.empty() ? "none" : all) + ".");
}

/// Pixels of the data window, top row first, RGB.
std::vector<float> ReadExrPixels(const std::string& path, const ExrWindows& windows)
{
  const std::int64_t left = windows.Data.min.x, top = windows.Data.min.y;
  const std::int64_t width = windows.Data.max.x - left + 1, height = windows.Data.max.y - top + 1;
  std::vector<float> pixels(static_cast<std::size_t>(3 * width * height));
  Imf::InputFile file(path.c_str());
  const Imf::Header& header = file.header();
  const auto same = [](const Imath::Box2i& a, const exr_attr_box2i_t& b) {
    return a.min.x == b.min.x && a.min.y == b.min.y && a.max.x == b.max.x && a.max.y == b.max.y;
  };
  if (!same(header.dataWindow(), windows.Data) || !same(header.displayWindow(), windows.Display))
  {
    Corrupt(path, "its windows are ambiguous");
  }
  if (!file.isComplete())
  {
    Corrupt(path, "parts of the picture are missing");
  }
  Require(!Imf::hasEnvmap(header) || Imf::envmap(header) != Imf::ENVMAP_CUBE,
    "\"" + path + "\" is a cube map. Convert it to latitude-longitude, for example with exrenvmap.");
  const ExrChannels channels = FindChannels(path, header.channels());
  if (channels.Chroma)
  {
    Imf::RgbaInputFile colours(path.c_str());
    std::vector<Imf::Rgba> halves(static_cast<std::size_t>(width * height));
    colours.setFrameBuffer(halves.data() - left - top * width, 1, static_cast<std::size_t>(width));
    colours.readPixels(windows.Data.min.y, windows.Data.max.y);
    for (std::size_t i = 0; i < halves.size(); ++i)
    {
      pixels[3 * i] = halves[i].r;
      pixels[3 * i + 1] = halves[i].g;
      pixels[3 * i + 2] = halves[i].b;
    }
    return pixels;
  }

  // OpenEXR expects the address of pixel (0, 0), which may lie outside of the data window.
  const std::size_t pixel = 3 * sizeof(float), row = pixel * static_cast<std::size_t>(width);
  const bool grey = channels.Names[0] == channels.Names[1];
  Imf::FrameBuffer buffer;
  for (int channel = 0; channel < (grey ? 1 : 3); ++channel)
  {
    char* base = reinterpret_cast<char*>(pixels.data() + channel) - left * static_cast<std::int64_t>(pixel) -
      top * static_cast<std::int64_t>(row);
    buffer.insert(channels.Names[channel].c_str(), Imf::Slice(Imf::FLOAT, base, pixel, row));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(windows.Data.min.y, windows.Data.max.y);
  for (std::size_t i = 0; grey && i < pixels.size(); i += 3)
  {
    pixels[i + 1] = pixels[i + 2] = pixels[i];
  }
  return pixels;
}
#endif
}

PictureSize SizeOfHdr(const std::string& path)
{
  const HdrHeader header = ParseHdrHeader(path, ReadBytes(path, LongestHdrHeader));
  CheckSize(path, header.Width, header.Height, ReadableSize(path));
  return { header.Width, header.Height };
}

RadiancePicture ReadHdr(const std::string& path)
{
  const std::vector<unsigned char> bytes = ReadBytes(path, UINT64_MAX);
  const HdrHeader header = ParseHdrHeader(path, bytes);
  CheckSize(path, header.Width, header.Height, bytes.size());
  RadiancePicture picture{ header.Width, header.Height, {} };
  picture.Rgb.resize(3 * static_cast<std::size_t>(header.Width) * static_cast<std::size_t>(header.Height));
  HdrRows rows(path, bytes, header);
  std::vector<unsigned char> rgbe(4 * static_cast<std::size_t>(header.Columns));
  for (int row = 0; row < header.Rows; ++row)
  {
    rows.Next(rgbe);
    for (int column = 0; column < header.Columns; ++column)
    {
      const int x = header.Transposed ? row : column, y = header.Transposed ? column : row;
      const int i = header.FromLeft ? x : header.Width - 1 - x;
      const int j = header.FromTop ? header.Height - 1 - y : y;
      float* pixel = &picture.Rgb[3 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(header.Width) + i)];
      const unsigned char* stored = &rgbe[4 * static_cast<std::size_t>(column)];
      // An 8-bit mantissa represents the middle of its interval, as in Radiance's own colr_color.
      const double scale = stored[3] == 0 ? 0.0 : std::ldexp(1.0, stored[3] - (128 + 8)) / header.Exposure;
      for (int channel = 0; channel < 3; ++channel)
      {
        pixel[channel] = static_cast<float>((stored[channel] + 0.5) * scale);
      }
      if (header.Xyz)
      {
        XyzToRgb(pixel);
      }
    }
  }
  return picture;
}

#ifdef TYNDALL_HAS_OPENEXR
PictureSize SizeOfExr(const std::string& path)
{
  const ExrWindows windows = WindowsOfExr(path);
  return { windows.Display.max.x - windows.Display.min.x + 1, windows.Display.max.y - windows.Display.min.y + 1 };
}

RadiancePicture ReadExr(const std::string& path)
{
  const ExrWindows windows = WindowsOfExr(path);
  std::vector<float> pixels;
  try
  {
    pixels = ReadExrPixels(path, windows);
  }
  catch (const InvalidInput&)
  {
    throw;
  }
  catch (const std::exception& error)
  {
    std::string why = error.what();
    while (!why.empty() && (why.back() == '.' || why.back() == '\n'))
    {
      why.pop_back();
    }
    Corrupt(path, "OpenEXR says: " + why);
  }

  const auto &data = windows.Data, &display = windows.Display;
  RadiancePicture picture{ display.max.x - display.min.x + 1, display.max.y - display.min.y + 1, {} };
  picture.Rgb.resize(3 * static_cast<std::size_t>(picture.Width) * static_cast<std::size_t>(picture.Height));
  const std::size_t dataWidth = static_cast<std::size_t>(data.max.x - data.min.x + 1);
  const int firstX = std::max(data.min.x, display.min.x), lastX = std::min(data.max.x, display.max.x);
  for (int y = std::max(data.min.y, display.min.y); y <= std::min(data.max.y, display.max.y) && firstX <= lastX; ++y)
  {
    const float* from = &pixels[3 * (static_cast<std::size_t>(y - data.min.y) * dataWidth + (firstX - data.min.x))];
    const std::size_t row = static_cast<std::size_t>(display.max.y - y);
    float* to = &picture.Rgb[3 * (row * static_cast<std::size_t>(picture.Width) + (firstX - display.min.x))];
    std::copy(from, from + 3 * (lastX - firstX + 1), to);
  }
  return picture;
}
#else
PictureSize SizeOfExr(const std::string& path)
{
  throw InvalidInput("\"" + path +
    "\" is not read: this build of Tyndall has no OpenEXR (TYNDALL_WITH_OPENEXR is off). Build it with OpenEXR 3, or "
    "convert the picture to .hdr.");
}

RadiancePicture ReadExr(const std::string& path)
{
  SizeOfExr(path);
  return {};
}
#endif
}
