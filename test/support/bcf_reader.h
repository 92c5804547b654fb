// SPDX-License-Identifier: BSD-3-Clause
// A second reader of BCF: zip archives by APPNOTE.TXT, and documents by the schemas of BCF-XML 2.1 and 3.0, of which it
// tells each deviation.
#pragma once

#include <pugixml.hpp>

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {

/// Reads an archive by its central directory.
inline std::map<std::string, std::string> filesOfZip(const std::string& zip)
{
  const auto number = [&](std::size_t at, std::size_t bytes) {
    std::uint64_t value = 0;
    std::memcpy(&value, zip.substr(at, bytes).data(), bytes);
    return static_cast<std::size_t>(value);
  };
  const std::size_t end = zip.rfind("PK\5\6");
  if (end == std::string::npos) throw std::runtime_error("no end of a central directory");
  std::map<std::string, std::string> files;
  std::size_t at = number(end + 16, 4);
  for (std::size_t i = 0; i < number(end + 10, 2); ++i) {
    if (zip.substr(at, 4) != "PK\1\2") throw std::runtime_error("no entry of a central directory");
    const std::size_t method = number(at + 10, 2), packed = number(at + 20, 4), size = number(at + 24, 4);
    const std::string name = zip.substr(at + 46, number(at + 28, 2));
    const std::size_t local = number(at + 42, 4);
    const std::size_t data = local + 30 + number(local + 26, 2) + number(local + 28, 2);
    std::string content(size, '\0');
    if (method == 0) content = zip.substr(data, size);
    if (method == 8) {
      z_stream stream{};
      inflateInit2(&stream, -15);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(zip.data() + data));
      stream.avail_in = static_cast<uInt>(packed);
      stream.next_out = reinterpret_cast<Bytef*>(content.data());
      stream.avail_out = static_cast<uInt>(size);
      const int done = inflate(&stream, Z_FINISH);
      inflateEnd(&stream);
      if (done != Z_STREAM_END) throw std::runtime_error(name + " cannot be inflated");
    }
    if (crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(size)) != number(at + 16, 4))
      throw std::runtime_error(name + " has another checksum");
    files[name] = content;
    at += 46 + number(at + 28, 2) + number(at + 30, 2) + number(at + 32, 2);
  }
  return files;
}

/// Width and height of a PNG whose chunks have the checksums that they say, by its specification.
inline std::pair<std::size_t, std::size_t> sizeOfPng(const std::string& png)
{
  const auto number = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(png.at(at + i));
    return value;
  };
  if (png.substr(0, 8) != "\x89PNG\r\n\x1a\n" || png.substr(12, 4) != "IHDR") throw std::runtime_error("no PNG");
  for (std::size_t at = 8;;) {
    const std::size_t bytes = number(at);
    const std::string content = png.substr(at + 4, 4 + bytes);
    if (crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())) !=
        number(at + 8 + bytes))
      throw std::runtime_error("a chunk has another checksum");
    at += 12 + bytes;
    if (content == "IEND" && at == png.size()) return {number(16), number(20)};
  }
}

/// Types as the schemas have them: attributes (@name:type, with ! where required), then the sequence of elements
/// (name:type, with ? * + as in regular expressions).
class BcfSchema {
public:
  explicit BcfSchema(bool is_version_3)
  {
    types_["Version"] = is_version_3 ? "@VersionId:string!" : "@VersionId:string! DetailedVersion:string";
    types_["Point"] = "X:double Y:double Z:double";
    types_["Line"] = "StartPoint:Point EndPoint:Point";
    types_["Lines"] = "Line:Line+";
    types_["Component"] = "@IfcGuid:ifcGuid OriginatingSystem:string? AuthoringToolId:string?";
    types_["Selection"] = "Component:Component+";
    types_["Visibility"] = "@DefaultVisibility:bool";
    types_["Components"] = "Selection:Selection? Visibility:Visibility";
    types_["Camera"] = "CameraViewPoint:Point CameraDirection:Point CameraUpVector:Point FieldOfView:angle";
    if (is_version_3) types_["Camera"] += " AspectRatio:double";
    types_["VisualizationInfo"] = "@Guid:guid! Components:Components? PerspectiveCamera:Camera Lines:Lines?";
    types_["CommentView"] = "@Guid:guid!";
    types_["Comment"] = "@Guid:guid! Date:dateTime Author:string Comment:string Viewpoint:CommentView? "
                        "ModifiedDate:dateTime? ModifiedAuthor:string?";
    types_["ViewPoint"] = "@Guid:guid! Viewpoint:string? Snapshot:string? Index:int?";
    const std::string people = "CreationDate:dateTime CreationAuthor:string ModifiedDate:dateTime? "
                               "ModifiedAuthor:string? DueDate:dateTime? AssignedTo:string? Stage:string? "
                               "Description:string? ";
    if (is_version_3) {
      types_["File"] = "@IfcProject:ifcGuid @IfcSpatialStructureElement:ifcGuid @IsExternal:bool Filename:string? "
                       "Date:dateTime? Reference:string?";
      types_["Files"] = "File:File*";
      types_["Header"] = "Files:Files?";
      types_["Labels"] = "Label:string*";
      types_["Comments"] = "Comment:Comment*";
      types_["Viewpoints"] = "ViewPoint:ViewPoint*";
      types_["DocumentReference"] = "@Guid:guid! DocumentGuid:guid? Url:string? Description:string?";
      types_["DocumentReferences"] = "DocumentReference:DocumentReference*";
      types_["Topic"] = "@Guid:guid! @ServerAssignedId:string @TopicType:string! @TopicStatus:string! Title:string "
                        "Priority:string? Index:int? Labels:Labels? " +
                        people + "DocumentReferences:DocumentReferences? Comments:Comments? Viewpoints:Viewpoints?";
      types_["Markup"] = "Header:Header? Topic:Topic";
      types_["Document"] = "@Guid:guid! Filename:string Description:string?";
      types_["Documents"] = "Document:Document*";
      types_["DocumentInfo"] = "Documents:Documents?";
      for (const auto& [all, one] : {std::pair{"TopicTypes", "TopicType"},
                                     {"TopicStatuses", "TopicStatus"},
                                     {"Priorities", "Priority"},
                                     {"TopicLabels", "TopicLabel"},
                                     {"Users", "User"},
                                     {"SnippetTypes", "SnippetType"},
                                     {"Stages", "Stage"}}) {
        types_[all] = std::string(one) + ":string*";
        types_["Extensions"] += std::string(all) + ":" + all + "? ";
      }
    }
    else {
      types_["File"] = "@IfcProject:ifcGuid @IfcSpatialStructureElement:ifcGuid @isExternal:bool Filename:string? "
                       "Date:dateTime? Reference:string?";
      types_["Header"] = "File:File+";
      types_["DocumentReference"] = "@Guid:guid @isExternal:bool ReferencedDocument:string? Description:string?";
      types_["Topic"] = "@Guid:guid! @TopicType:string @TopicStatus:string ReferenceLink:string* Title:string "
                        "Priority:string? Index:int? Labels:string* " +
                        people + "DocumentReference:DocumentReference*";
      types_["Markup"] = "Header:Header? Topic:Topic Comment:Comment* Viewpoints:ViewPoint*";
    }
  }

  /// The faults of a document, a line each. Its root element names its type.
  std::string faultsOf(const std::string& xml) const
  {
    pugi::xml_document document;
    if (!document.load_buffer(xml.data(), xml.size())) return "no XML\n";
    const pugi::xml_node root = document.document_element();
    return types_.contains(root.name()) ? faultsOf(root, root.name()) : std::string("unknown ") + root.name() + '\n';
  }

private:
  static std::string faultOfText(const std::string& text, const std::string& type)
  {
    static const std::map<std::string, std::string> patterns = {
        {"string", "[\\s\\S]*"},
        {"guid", "[a-f0-9]{8}-[a-f0-9]{4}-[a-f0-9]{4}-[a-f0-9]{4}-[a-f0-9]{12}"},
        {"ifcGuid", "[0-9A-Za-z_$]{22}"},
        {"dateTime", "\\d{4}-\\d\\d-\\d\\dT\\d\\d:\\d\\d:\\d\\d(\\.\\d+)?(Z|[+-]\\d\\d:\\d\\d)?"},
        {"int", "[+-]?\\d+"},
        {"bool", "true|false|1|0"},
        {"double", "[+-]?\\d+(\\.\\d*)?([eE][+-]?\\d+)?"},
        {"angle", "4[5-9](\\.\\d*)?|5\\d(\\.\\d*)?|60"}};
    return std::regex_match(text, std::regex(patterns.at(type))) ? "" : "'" + text + "' is no " + type + '\n';
  }

  std::string faultsOf(const pugi::xml_node& node, const std::string& type) const
  {
    const std::string name = node.name();
    if (!types_.contains(type)) {
      if (node.first_child().type() == pugi::node_element) return name + " has children\n";
      return faultOfText(node.child_value(), type);
    }
    std::string faults, attributes;
    std::vector<pugi::xml_node> children(node.begin(), node.end());
    std::size_t next = 0;
    std::istringstream rules(types_.at(type));
    for (std::string rule; rules >> rule;) {
      const char last = rule.back();
      const bool optional = last == '?' || last == '*', repeated = last == '*' || last == '+';
      const bool required = last == '!';
      if (optional || repeated || required) rule.pop_back();
      const std::string kind = rule.substr(rule.find(':') + 1), key = rule.substr(0, rule.find(':'));
      if (key[0] == '@') {
        const auto attribute = node.attribute(key.c_str() + 1);
        if (required && !attribute) faults += name + " lacks " + key + '\n';
        if (attribute) faults += faultOfText(attribute.value(), kind);
        attributes += ' ' + key.substr(1) + ' ';
        continue;
      }
      std::size_t count = 0;
      for (; next < children.size() && children[next].name() == key; ++next, ++count)
        faults += faultsOf(children[next], kind);
      if (count == 0 && !optional) faults += name + " lacks " + key + '\n';
      if (count > 1 && !repeated) faults += name + " has two " + key + '\n';
    }
    if (next < children.size()) faults += name + " has " + children[next].name() + " out of place\n";
    for (const auto& attribute : node.attributes())
      if (attributes.find(std::string(" ") + attribute.name() + ' ') == std::string::npos)
        faults += name + " has an attribute " + attribute.name() + '\n';
    return faults;
  }

  std::map<std::string, std::string> types_;
};

} // namespace pcl_bsh
