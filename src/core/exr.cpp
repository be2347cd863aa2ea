#include "core/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <set>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/parallel.h"

namespace gradslc {
namespace {

/// OpenEXR compresses in its own pool of threads, which is empty at first.
void use_all_threads() {
  if (Imf::globalThreadCount() < thread_count()) Imf::setGlobalThreadCount(thread_count());
}

/// A slice whose pixel `origin` is at `first`; rows follow each other without gaps.
Imf::Slice float_slice(const float* first, std::size_t floats_per_pixel, const Imath::V2i& origin, std::size_t width) {
  const std::size_t pixel_bytes = floats_per_pixel * sizeof(float);
  return Imf::Slice::Make(Imf::FLOAT, first, origin, static_cast<int64_t>(width), 1, pixel_bytes, pixel_bytes * width);
}

/// Names the channels of a layer and the memory that OpenEXR writes them from or reads them to.
void insert_slices(const std::string& layer, const RgbImage& image, const Imath::V2i& origin,
                   Imf::FrameBuffer& buffer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  const auto width = static_cast<std::size_t>(image.width());
  buffer.insert(prefix + "R", float_slice(&image[0].r, 3, origin, width));
  buffer.insert(prefix + "G", float_slice(&image[0].g, 3, origin, width));
  buffer.insert(prefix + "B", float_slice(&image[0].b, 3, origin, width));
}
void insert_slices(const std::string& layer, const Image<float>& image, const Imath::V2i& origin,
                   Imf::FrameBuffer& buffer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  buffer.insert(prefix + "Y", float_slice(&image[0], 1, origin, static_cast<std::size_t>(image.width())));
}

/// `layer` and `channel` of a channel's full name, parted at the last dot.
struct ChannelName {
  std::string layer, channel;
};
ChannelName split_channel_name(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos) return {"", name};
  return {name.substr(0, dot), name.substr(dot + 1)};
}

/// Layers that are complete, with images of the data window's size.
std::map<std::string, ExrLayer> allocate_layers(const Imf::ChannelList& channels, Resolution resolution) {
  std::map<std::string, std::set<std::string>> found;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    const ChannelName name = split_channel_name(channel.name());
    found[name.layer].insert(name.channel);
  }
  std::map<std::string, ExrLayer> layers;
  for (const auto& [layer, names] : found) {
    if (names.contains("R") && names.contains("G") && names.contains("B"))
      layers.emplace(layer, RgbImage(resolution));
    else if (names.contains("Y"))
      layers.emplace(layer, Image<float>(resolution));
  }
  return layers;
}

std::string channel_names(const Imf::ChannelList& channels) {
  std::vector<std::string> names;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) names.emplace_back(channel.name());
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

double pixel_count(const Imath::Box2i& box) {
  return (static_cast<double>(box.max.x) - box.min.x + 1) * (static_cast<double>(box.max.y) - box.min.y + 1);
}

/// Damaged headers ask for any size. No more memory is taken than 256 MiB, or what a file of `file_size` bytes may hold
/// when compressed two thousandfold (deflate reaches 1032).
void check_size(const std::filesystem::path& path, const Imf::Header& header, std::size_t file_size) {
  double channels = 0;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) ++channels;
  const double pixels = pixel_count(header.dataWindow()) + pixel_count(header.displayWindow());
  const double limit = std::max(0x1p28, 2000.0 * static_cast<double>(file_size));
  if (pixels * channels * sizeof(float) > limit)
    throw_input_error(path.string(), fmt::format("is damaged: its header asks for {:.3g} pixels of {} channels, more "
                                                 "than a file of {} bytes holds",
                                                 pixels, channels, file_size));
}

/// `data`, which begins at the data window's corner, as an image of the display window.
template <class T>
Image<T> fit_to_display(Image<T> data, const Imath::Box2i& data_window, const Imath::Box2i& display_window) {
  if (data_window == display_window) return data;
  Image<T> image({display_window.max.x - display_window.min.x + 1, display_window.max.y - display_window.min.y + 1});
  const int x_begin = std::max(data_window.min.x, display_window.min.x);
  const int x_end = std::min(data_window.max.x, display_window.max.x) + 1;
  const int y_begin = std::max(data_window.min.y, display_window.min.y);
  const int y_end = std::min(data_window.max.y, display_window.max.y) + 1;
  for (int y = y_begin; y < y_end; ++y)
    for (int x = x_begin; x < x_end; ++x)
      image(x - display_window.min.x, y - display_window.min.y) = data(x - data_window.min.x, y - data_window.min.y);
  return image;
}

std::map<std::string, std::string> string_attributes(const Imf::Header& header) {
  std::map<std::string, std::string> attributes;
  for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
      attributes[attribute.name()] = text->value();
  return attributes;
}

void check_channels(const std::filesystem::path& path, const Imf::ChannelList& channels) {
  const bool coloured = channels.findChannel("R") || channels.findChannel("G") || channels.findChannel("B");
  if (!coloured && channels.findChannel("Y")) return;
  for (const char* name : {"R", "G", "B"})
    if (!channels.findChannel(name))
      throw_input_error(path.string(), fmt::format("has no channel {}; R, G and B, or Y, are needed, there are: {}",
                                                   name, channel_names(channels)));
}

RgbImage to_rgb(RgbImage image) { return image; }
RgbImage to_rgb(const Image<float>& grey) {
  RgbImage image(grey.resolution());
  std::transform(grey.begin(), grey.end(), image.begin(), [](float value) { return Rgb(value); });
  return image;
}

ExrImage decode(const std::string& bytes, const std::filesystem::path& path) {
  Imf::StdISStream stream;
  stream.str(bytes);
  Imf::InputFile file(stream);
  const Imf::Header& header = file.header();
  const Imf::ChannelList& channels = header.channels();
  check_channels(path, channels);
  check_size(path, header, bytes.size());

  const Imath::Box2i window = header.dataWindow();
  ExrImage result{.image = {}, .layers = {}, .attributes = string_attributes(header)};
  result.layers = allocate_layers(channels, {window.max.x - window.min.x + 1, window.max.y - window.min.y + 1});
  Imf::FrameBuffer buffer;
  for (auto& [name, layer] : result.layers)
    std::visit([&, &layer_name = name](auto& image) { insert_slices(layer_name, image, window.min, buffer); }, layer);
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);

  for (auto& [name, layer] : result.layers)
    std::visit([&](auto& image) { image = fit_to_display(std::move(image), window, header.displayWindow()); }, layer);
  result.image = std::visit([](auto& image) { return to_rgb(std::move(image)); }, result.layers.at(""));
  result.layers.erase("");
  return result;
}

/// Encodes into memory: OpenEXR's file destructor swallows the error of a full disk.
std::string encode(const ExrImage& content) {
  const Resolution resolution = content.image.resolution();
  Imf::Header header(resolution.width, resolution.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, value] : content.attributes) header.insert(name, Imf::StringAttribute(value));
  Imf::FrameBuffer buffer;
  insert_slices("", content.image, {0, 0}, buffer);
  for (const auto& [name, layer] : content.layers)
    std::visit(
        [&, &layer_name = name](const auto& image) {
          assert(image.resolution() == resolution && !layer_name.empty());
          insert_slices(layer_name, image, {0, 0}, buffer);
        },
        layer);
  for (auto slice = buffer.begin(); slice != buffer.end(); ++slice)
    header.channels().insert(slice.name(), Imf::Channel(Imf::FLOAT));

  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(buffer);
    file.writePixels(resolution.height);
  }
  return stream.str();
}

}  // namespace

void write_exr(const std::filesystem::path& path, const ExrImage& content) {
  if (content.image.empty()) throw_failure(path.string(), "cannot be written: the image has no pixels");
  use_all_threads();
  std::string bytes;
  try {
    bytes = encode(content);
  } catch (const std::exception& exception) {
    throw_failure(path.string(), fmt::format("cannot be written: {}", exception.what()));
  }
  write_file_atomically(path, bytes);
}

ExrImage read_exr(const std::filesystem::path& path) { return decode_exr(read_file(path), path); }

ExrImage decode_exr(const std::string& bytes, const std::filesystem::path& path) {
  use_all_threads();
  try {
    return decode(bytes, path);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& exception) {
    throw_input_error(path.string(), fmt::format("is no readable EXR file: {}", exception.what()));
  }
}

}  // namespace gradslc
