#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/loaders/loader.h"
#include "scene/loaders/xml_document.h"

namespace gradslc {

/// A Mitsuba scene file as XML, its includes opened, its parameters substituted and its ids known: what elements say,
/// before anybody asks what they mean.
class MitsubaDocument {
 public:
  /// `options` must outlive this.
  MitsubaDocument(const std::filesystem::path& file, const LoadOptions& options);
  /// The same for text in memory; `file` is its name in messages, and includes are sought in its folder.
  MitsubaDocument(const std::filesystem::path& file, std::string text, const LoadOptions& options);

  /// The <scene> of the outermost file.
  XmlElement root() const { return {documents_.front().get(), documents_.front()->root()}; }
  /// Line of an element in its file.
  int line(const XmlElement& element) const { return element.document->line(element.node); }
  /// The objects of the scene, those of included files in the place of the include.
  const std::vector<XmlElement>& objects() const { return objects_; }
  /// The element with that id, wherever it stands; a null node where there is none.
  XmlElement find(std::string_view id) const;
  /// End of a message about an unknown id: the nearest one, or all.
  std::string id_hint(std::string_view id) const;

  /// Value of an attribute with every $name replaced; empty where the attribute is missing.
  std::string attribute(const XmlElement& element, const char* name) const;
  /// The same; an error where it is missing or empty.
  std::string required_attribute(const XmlElement& element, const char* name) const;
  /// Name of a property or plug-in as Mitsuba 3 spells it: names of dialect 0.6 are translated (toWorld -> to_world).
  std::string modern_name(const XmlElement& element, std::string_view name) const;
  /// Whether the element stands in a file of dialect 0.5/0.6.
  bool is_legacy(const XmlElement& element) const { return legacy_.contains(element.document); }
  /// A file named in the scene, relative to the file that names it.
  std::filesystem::path resolve_path(const XmlElement& element, const std::string& path) const;
  /// Remembers a file that the scene is read from; the XML files are known already. Not from several threads.
  void add_file(const std::filesystem::path& file);
  /// In the order in which they were first named, each once.
  const std::vector<std::filesystem::path>& files() const { return files_; }

  /// Throws Error (input) at the element or, where it is given, at one of its attributes.
  [[noreturn]] void fail(const XmlElement& element, std::string message, std::string_view attribute = {}) const;
  /// What is not recognised: an error, or a note where the options are permissive. `instead` says in the note what is
  /// done about it.
  void unknown(const XmlElement& element, std::string message, std::string_view attribute = {},
               std::string_view instead = "ignored");
  /// What is recognised and has no effect.
  void note(const XmlElement& element, std::string_view message);
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  using Documents = std::vector<std::unique_ptr<XmlDocument>>;
  void read(std::unique_ptr<XmlDocument> document, int depth);
  void read_include(const XmlElement& element, int depth);
  void read_default(const XmlElement& element);
  void read_alias(const XmlElement& element);
  void register_ids(const XmlElement& element, int depth);
  void add_id(const XmlElement& element, const std::string& id, std::string_view attribute);
  void check_definitions() const;
  std::string substitute(const XmlElement& element, const char* name, std::string_view value) const;

  const LoadOptions& options_;
  Documents documents_;
  std::set<const XmlDocument*> legacy_;
  std::vector<XmlElement> objects_;
  std::map<std::string, XmlElement, std::less<>> ids_;
  std::map<std::string, std::string, std::less<>> definitions_;
  mutable std::set<std::string, std::less<>> used_definitions_;
  std::vector<std::string> notes_;
  std::set<std::string> known_notes_;
  std::vector<std::filesystem::path> files_;
  std::set<std::filesystem::path> known_files_;
};

/// snake_case of a camelCase name: intIOR -> int_ior, toWorld -> to_world.
std::string snake_case(std::string_view camel_case);

}  // namespace gradslc
