// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <burnish/error.h>
#include <burnish/io/slice_image.h>

namespace burnish {

std::string format_slice_image(const HalfDiffTable& table) {
  if (table.channel_count != 1 && table.channel_count != 3)
    throw Error("slices: expected a grey or RGB table, found " + std::to_string(table.channel_count) +
                " channels");

  // Slices of phi_d stand in rows, as square as can be. Holes stay transparent.
  const auto channels = table.channel_count;
  const int across = static_cast<int>(std::ceil(std::sqrt(table.phi_d_count)));
  const int down = (table.phi_d_count + across - 1) / across;
  const int width = across * table.theta_d_count, height = down * table.theta_h_count;
  const std::size_t pixel = channels + 1;  // the last channel is A
  std::vector<float> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * pixel, 0.0f);
  for (int p = 0; p < table.phi_d_count; ++p)
    for (int h = 0; h < table.theta_h_count; ++h)
      for (int d = 0; d < table.theta_d_count; ++d) {
        const float* entry = &table.values[table.offset(h, d, p)];
        if (std::isnan(entry[0])) continue;
        const int x = p % across * table.theta_d_count + d, y = p / across * table.theta_h_count + h;
        float* to = &pixels[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x)) *
                            pixel];
        for (std::size_t c = 0; c < channels; ++c) to[c] = entry[c];
        to[channels] = 1;
      }

  // The attributes state all that is needed to find an entry in the picture.
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.insert("thetaHCount", Imf::IntAttribute(table.theta_h_count));
  header.insert("thetaDCount", Imf::IntAttribute(table.theta_d_count));
  header.insert("phiDCount", Imf::IntAttribute(table.phi_d_count));
  header.insert("phiDRange", Imf::StringAttribute(table.full_circle ? "360 degrees" : "180 degrees"));
  Imf::FrameBuffer frame;
  const std::array<const char*, 4> rgba = {"R", "G", "B", "A"}, grey = {"Y", "A", "", ""};
  for (std::size_t c = 0; c < pixel; ++c) {
    const char* name = (channels == 3 ? rgba : grey)[c];
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&pixels[c]), pixel * sizeof(float),
                                  pixel * sizeof(float) * static_cast<std::size_t>(width)));
  }
  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(height);
  }
  return stream.str();
}

}  // namespace burnish
