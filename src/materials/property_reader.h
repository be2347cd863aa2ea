#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "materials/texture.h"

namespace gradslc {

class Material;
using MaterialPtr = std::shared_ptr<const Material>;

/// The properties of one plug-in element of a scene file, by their snake_case (Mitsuba 3) names; the 0.6 dialect's
/// camelCase is translated by the reader. Reading marks a property as known; what is left unread is reported as an
/// error.
class PropertyReader {
 public:
  virtual ~PropertyReader() = default;
  virtual bool has(std::string_view name) const = 0;
  /// Whether it is given as text, for properties that take a number or a name.
  virtual bool is_text(std::string_view name) const = 0;
  virtual bool boolean(std::string_view name, bool default_value) = 0;
  virtual float real(std::string_view name, float default_value) = 0;
  virtual std::string text(std::string_view name, std::string_view default_value) = 0;
  virtual Rgb colour(std::string_view name, Rgb default_value) = 0;
  virtual Texture texture(std::string_view name, Rgb default_value) = 0;
  /// Nested or referenced textures that no other property has read, in the order of the file.
  virtual std::vector<Texture> nested_textures() = 0;
  /// Nested or referenced BSDFs, in the order of the file.
  virtual std::vector<MaterialPtr> nested_materials() = 0;
  /// Accepts a property that has no effect here, and notes it where it is given.
  virtual void ignore(std::string_view name) = 0;
  /// Bad input: reports the property's (or, if empty, the element's) position.
  [[noreturn]] virtual void fail(std::string_view name, const std::string& message) const = 0;
};

}  // namespace gradslc
