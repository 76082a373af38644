// Triangles into a depth buffer, shaded by their normals; then rows, compressed, in PNG's chunks.
#include "support/picture.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace odds::testing {
namespace {

using Colour = std::array<double, 3>;
constexpr Colour paper{250, 250, 249};
constexpr Colour still{176, 182, 188};
constexpr std::array<Colour, 5> moving{
    {{86, 148, 200}, {222, 150, 70}, {96, 170, 130}, {196, 110, 160}, {150, 140, 200}}};

struct Canvas {
  explicit Canvas(const View& of) : view(of) {
    const std::size_t pixels = std::size_t{view.columns} * view.rows;
    depth.assign(pixels, -std::numeric_limits<double>::infinity());
    colour.assign(pixels, paper);
    towards = view.from.normalized();
    right = Vec3::UnitZ().cross(towards).normalized();
    up = towards.cross(right);
    scale = view.columns / view.width_m;
  }
  [[nodiscard]] Vec3 seen(const Vec3& point) const {
    const Vec3 p = point - view.centre;
    return {0.5 * view.columns + scale * right.dot(p), 0.5 * view.rows - scale * up.dot(p), towards.dot(p)};
  }
  void draw(const std::array<Vec3, 3>& corners, const Colour& base) {
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    if (!(std::abs(normal.dot(towards)) > 1e-9)) return;
    const double light = 0.45 + 0.55 * std::abs(normal.dot((towards + 0.6 * up - 0.4 * right).normalized()));
    const Vec3 a = seen(corners[0]);
    const Vec3 b = seen(corners[1]);
    const Vec3 c = seen(corners[2]);
    const auto first = [](double least, std::uint32_t most) {
      return static_cast<std::uint32_t>(std::clamp(std::floor(least), 0.0, static_cast<double>(most)));
    };
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (area == 0.0) return;
    for (std::uint32_t row = first(std::min({a.y(), b.y(), c.y()}), view.rows);
         row < first(std::max({a.y(), b.y(), c.y()}) + 1.0, view.rows); ++row) {
      for (std::uint32_t column = first(std::min({a.x(), b.x(), c.x()}), view.columns);
           column < first(std::max({a.x(), b.x(), c.x()}) + 1.0, view.columns); ++column) {
        const double x = column + 0.5;
        const double y = row + 0.5;
        const double v = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) / area;
        const double w = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) / area;
        if (v < 0.0 || w < 0.0 || v + w > 1.0) continue;
        const double z = a.z() + v * (b.z() - a.z()) + w * (c.z() - a.z());
        const std::size_t pixel = std::size_t{row} * view.columns + column;
        if (z <= depth[pixel]) continue;
        depth[pixel] = z;
        for (std::size_t i = 0; i < 3; ++i) colour[pixel][i] = light * base[i];
      }
    }
  }

  View view;
  Vec3 towards, right, up;
  double scale;
  std::vector<double> depth;
  std::vector<Colour> colour;
};

void big_endian(std::string& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>((number >> shift) & 0xffU));
}

void chunk(std::string& png, const std::string& kind, const std::string& data) {
  big_endian(png, static_cast<std::uint32_t>(data.size()));
  const std::string checked = kind + data;
  png += checked;
  big_endian(png, static_cast<std::uint32_t>(
                      crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()))));
}

std::string encode(const Canvas& canvas) {
  std::string rows;
  for (std::size_t row = 0; row < canvas.view.rows; ++row) {
    rows.push_back(0);  // no filter
    for (std::size_t column = 0; column < canvas.view.columns; ++column) {
      for (const double part : canvas.colour[row * canvas.view.columns + column]) {
        rows.push_back(static_cast<char>(static_cast<unsigned char>(std::clamp(part, 0.0, 255.0))));
      }
    }
  }
  uLongf length = compressBound(static_cast<uLong>(rows.size()));
  std::string packed(length, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(rows.data()),
                static_cast<uLong>(rows.size()), 9) != Z_OK) {
    throw std::runtime_error("zlib cannot compress a picture");
  }
  packed.resize(length);
  std::string png = "\x89PNG\r\n\x1a\n";
  std::string head;
  big_endian(head, canvas.view.columns);
  big_endian(head, canvas.view.rows);
  head += std::string("\x08\x02\x00\x00\x00", 5);  // eight bits, red green blue
  chunk(png, "IHDR", head);
  chunk(png, "IDAT", packed);
  chunk(png, "IEND", "");
  return png;
}

}  // namespace

std::string picture_of(std::span<const Drawn> bodies, const View& view) {
  Canvas canvas(view);
  std::size_t others = 0;
  for (const Drawn& body : bodies) {
    const Colour& colour = body.fixed ? still : moving[others++ % moving.size()];
    for (const mesh::Triangle& t : body.mesh->triangles()) {
      std::array<Vec3, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) corners[i] = body.pose * body.mesh->vertices()[t[i]];
      const double nearest = std::min({corners[0].y(), corners[1].y(), corners[2].y()});
      if (body.fixed && nearest < -view.cut_y) continue;
      canvas.draw(corners, colour);
    }
  }
  return encode(canvas);
}

}  // namespace odds::testing
