#pragma once
/** @file ReadPng.hpp
 * read_png(): a picture that a program has written, for tests. */
#include <png.h>

#include <stdexcept>
#include <string>

#include "CME212/viewer/Image.hpp"

/** The PNG file @a path.  Throws std::runtime_error "path: reason". */
inline CME212::Image read_png(const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const bool begun = png_image_begin_read_from_file(&png, path.c_str());
  png.format = PNG_FORMAT_RGB;
  CME212::Image image(int(png.width), int(png.height));
  if (!begun ||
      !png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr))
    throw std::runtime_error(path + ": " + png.message);
  return image;
}
