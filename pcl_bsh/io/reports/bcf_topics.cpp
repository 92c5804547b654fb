// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/bcf_topics.h>
#include <pcl_bsh/io/reports/zip_archive.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/small_letters.h>

#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <pugixml.hpp>

#include <regex>

namespace pcl_bsh::io {

namespace {

/// The namespace of this project's names: itself that of an address.
boost::uuids::uuid bcfNamespace()
{
  return boost::uuids::name_generator_sha1(boost::uuids::ns::url())("https://pcl_bsh/clashes");
}

bool isMarkup(const std::string& name)
{
  return name.ends_with("/markup.bcf");
}

/// The element's xs:dateTime, or empty text: some programs write an empty element.
std::string dateOf(const pugi::xml_node& node, const char* name)
{
  static const std::regex date_time(R"(-?\d{4,}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]\d\d:\d\d)?)");
  const std::string text = node.child_value(name);
  constexpr std::size_t longest = 64;
  return text.size() <= longest && std::regex_match(text, date_time) ? text : std::string();
}

BcfComment commentFrom(const pugi::xml_node& node)
{
  BcfComment comment{inSmallLetters(node.attribute("Guid").value()),
                     dateOf(node, "Date"),
                     node.child_value("Author"),
                     node.child_value("Comment"),
                     dateOf(node, "ModifiedDate"),
                     node.child_value("ModifiedAuthor")};
  if (comment.guid.empty()) comment.guid = bcfGuid(comment.date + comment.author + comment.text);
  return comment;
}

/// Comments stand beside the topic, and in version 3 within it.
BcfTopic topicFrom(const pugi::xml_node& markup)
{
  const auto node = markup.child("Topic");
  BcfTopic topic{node.attribute("TopicStatus").value(),
                 node.child_value("Priority"),
                 dateOf(node, "CreationDate"),
                 node.child_value("CreationAuthor"),
                 dateOf(node, "DueDate"),
                 node.child_value("AssignedTo"),
                 node.child_value("Stage"),
                 {}};
  for (const auto& parent : {markup, node.child("Comments")})
    for (const auto& comment : parent.children("Comment")) topic.comments.push_back(commentFrom(comment));
  return topic;
}

} // namespace

std::string bcfGuid(const std::string& name)
{
  return boost::uuids::to_string(boost::uuids::name_generator_sha1(bcfNamespace())(name));
}

std::string bcfListDocument()
{
  return "documents/" + bcfGuid(bcf_list_file);
}

BcfContents parseBcf(std::string_view archive)
{
  const std::string document = bcfListDocument();
  ZipFiles files = unzipped(
      archive, [&](const std::string& name) { return isMarkup(name) || name == document || name == bcf_list_file; });
  BcfContents contents;
  for (const auto& [name, xml] : files) {
    if (!isMarkup(name)) continue;
    pugi::xml_document markup;
    const pugi::xml_parse_result parsed = markup.load_buffer(xml.data(), xml.size());
    const std::string guid = inSmallLetters(markup.child("Markup").child("Topic").attribute("Guid").value());
    if (!parsed || guid.empty())
      throw FormatError("has '" + name + "', which is no topic: " + (parsed ? "it has no Guid" : parsed.description()));
    contents.topics[guid] = topicFrom(markup.child("Markup"));
  }
  const auto list = files.contains(document) ? files.find(document) : files.find(bcf_list_file);
  if (list == files.end())
    throw FormatError("holds no list of clashes, as its program left out the document clashes.json",
                      "compare with the .json list of that run");
  contents.list = std::move(list->second);
  return contents;
}

} // namespace pcl_bsh::io
