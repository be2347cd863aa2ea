#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/rgb.h"
#include "core/vec.h"
#include "scene/loaders/mitsuba_document.h"
#include "scene/loaders/transform.h"

namespace gradslc {

/// The properties and nested objects of one plug-in element. Names are those of Mitsuba 3. Reading a property marks it
/// as known; finish() reports what nobody asked for.
class MitsubaProperties {
 public:
  MitsubaProperties(MitsubaDocument& document, XmlElement element);

  const XmlElement& element() const { return element_; }
  /// The plug-in's name: the element's type attribute.
  const std::string& plugin() const { return plugin_; }
  /// The element's id; empty where it has none.
  std::string id() const;

  bool has(std::string_view name) const;
  /// Whether it is given as a <string>.
  bool is_text(std::string_view name) const;
  bool boolean(std::string_view name, bool default_value);
  int integer(std::string_view name, int default_value);
  float real(std::string_view name, float default_value);
  std::string text(std::string_view name, std::string_view default_value);
  Rgb colour(std::string_view name, Rgb default_value);
  /// Of a <vector> or <point>: attributes x, y and z, or `value` with three numbers.
  Vec3 vector(std::string_view name, Vec3 default_value);
  Point3 point(std::string_view name, Point3 default_value);
  Transform transform(std::string_view name);
  /// The nested or referenced objects of that kind ("bsdf", "emitter" ...), with a name or without.
  std::vector<XmlElement> objects(std::string_view kind);
  /// The nested or referenced texture of that name; nullopt where there is none or the property is something else.
  std::optional<XmlElement> texture_element(std::string_view name);
  /// The nested or referenced objects of that kind that nothing has read yet.
  std::vector<XmlElement> unread_objects(std::string_view kind);
  /// Accepts a property of any type that has no effect here, and notes it where it is given.
  void ignore(std::string_view name);

  /// Everything that has not been read is unknown.
  void finish();
  /// Throws Error (input) at the property or, where the name is empty or not given, at the element.
  [[noreturn]] void fail(std::string_view name, const std::string& message) const;

 private:
  struct Entry {
    std::string name;    // snake_case; empty for objects without a name
    std::string type;    // tag: "float", "bsdf" ...; of the target for references
    XmlElement element;  // the property
    XmlElement target;   // what a reference means; the element itself otherwise
    bool read = false;
  };
  void add(const XmlElement& child);
  Entry* take(std::string_view name);  // marks as read
  Entry* take(std::string_view name, std::initializer_list<std::string_view> types, std::string_view expected);
  std::string value(const Entry& entry) const;

  MitsubaDocument& document_;
  XmlElement element_;
  std::string plugin_;
  std::vector<Entry> entries_;
  std::set<std::string, std::less<>> given_;  // names in the file
  std::set<std::string, std::less<>> known_;  // names that were asked for
};

}  // namespace gradslc
