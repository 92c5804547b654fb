// SPDX-License-Identifier: BSD-3-Clause
// Clashes as BCF: a topic and a viewpoint for each.
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/reports/clash_drawings.h>
#include <pcl_bsh/io/reports/picture.h>
#include <pcl_bsh/io/reports/report_origin.h>
#include <pcl_bsh/io/reports/zip_archive.h>
#include <pcl_bsh/io/text/number_text.h>

#include <pugixml.hpp>

#include <cmath>
#include <set>
#include <sstream>

namespace pcl_bsh::io {

namespace {

using Eigen::Vector3d;

constexpr double snapshot_pixels = 1.5; ///< per unit of the drawing: more take long
constexpr auto bcf_author = "pcl_bsh", open_topic = "Open", closed_topic = "Closed", snapshot_file = "snapshot.png";

/// As XML can hold it: UTF-8 without control characters.
std::string xmlText(const std::string& text)
{
  std::string plain = validUtf8(text);
  for (char& c : plain)
    if (static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t') c = '?';
  return plain;
}

pugi::xml_node addText(pugi::xml_node parent, const char* name, const std::string& text)
{
  pugi::xml_node child = parent.append_child(name);
  child.text().set(xmlText(text).c_str());
  return child;
}

void addTextIfAny(const pugi::xml_node& parent, const char* name, const std::string& text)
{
  if (!text.empty()) addText(parent, name, text);
}

std::string textOf(const pugi::xml_document& document)
{
  std::ostringstream out;
  document.save(out, "  ", pugi::format_default, pugi::encoding_utf8);
  return out.str();
}

/// BCF counts in metres.
double metresOf(const std::string& unit)
{
  for (const auto& [name, metres] :
       {std::pair{"mm", 0.001}, {"cm", 0.01}, {"km", 1000.0}, {"in", 0.0254}, {"ft", 0.3048}, {"us-ft", 1200.0 / 3937}})
    if (unit == name) return metres;
  return 1;
}

class BcfArchive {
public:
  BcfArchive(const ClashLists& lists, bool is_version_3)
  : lists_(lists),
    drawings_(lists),
    report_(&lists.obstacles.front()),
    is_3_(is_version_3),
    date_(reportDate()),
    metres_(metresOf(report_->unit))
  {
  }

  std::string bytes()
  {
    pugi::xml_document version;
    pugi::xml_node root = version.append_child("Version");
    root.append_attribute("VersionId") = is_3_ ? "3.0" : "2.1";
    if (!is_3_) addText(root, "DetailedVersion", "2.1");
    files_["bcf.version"] = textOf(version);
    for (const auto& [report, clash] : lists_.bySeverity()) {
      report_ = report;
      addClash(*clash);
    }
    if (is_3_) {
      addExtensions();
      addDocuments();
    }
    else {
      files_[bcf_list_file] = clashJson(lists_);
    }
    return zipped(files_, date_);
  }

private:
  const BcfTopic* earlierOf(const std::string& guid) const
  {
    const auto found = report_->topics.find(guid);
    return found == report_->topics.end() ? nullptr : &found->second;
  }

  /// The state that people gave a topic stays, but what is resolved is closed, and what is new is open.
  static std::string statusOf(const Clash& clash, const BcfTopic* earlier)
  {
    if (clash.status == ClashStatus::resolved) return closed_topic;
    return clash.status == ClashStatus::fresh || !earlier || earlier->status.empty() ? open_topic : earlier->status;
  }

  /// The obstacle's name where obstacles have names, else the name of its file.
  std::string obstacleName() const
  {
    return report_->name.empty() ? fileName(report_->question.obstacle) : report_->name;
  }

  std::string titleOf(const Clash& clash) const
  {
    const std::string names = obstacleName() + " in " + fileName(report_->question.input);
    if (clash.wasNoClash()) return report_->idOf(clash) + ": unseen, " + names;
    const std::string length = numberText(std::abs(clash.distance), std::chars_format::general, 4);
    return report_->idOf(clash) + ": " + withUnit(length) + (clash.isDeep() ? " deep, " : ", ") + names;
  }

  std::string descriptionOf(const Clash& clash) const
  {
    const auto place = [](const Point3& p) {
      return numberText(p[0]) + ", " + numberText(p[1]) + ", " + numberText(p[2]);
    };
    std::string text = std::string("state: ") + nameOf(clash.status) + (clash.isCertain() ? "" : ", perhaps") + '\n';
    if (!clash.wasNoClash())
      text +=
          (clash.isDeep() ? "depth: " + lengthText(-clash.distance) : "distance: " + lengthText(clash.distance)) + '\n';
    text += "place: " + place(clash.place) + '\n';
    text += "box: from " + place(clash.low) + " to " + place(clash.high) + '\n';
    if (!report_->coordinate_system.empty()) text += "coordinate system: " + report_->coordinate_system + '\n';
    text += "unit: " + (report_->unit.empty() ? std::string("not known") : report_->unit) + '\n';
    text += counted(clash.points, "point") + ", first at pose " + std::to_string(clash.first_pose) +
            ", nearest at pose " + std::to_string(clash.closest_pose) + '\n';
    return text + "clearance: " + lengthText(*report_->question.clearance);
  }

  std::string withUnit(const std::string& number) const
  {
    return number + (report_->unit.empty() ? "" : ' ' + report_->unit);
  }

  std::string lengthText(double length) const { return withUnit(numberText(length)); }

  static std::string fileName(const std::string& path) { return std::filesystem::path(path).filename().string(); }

  std::string now() const { return date_ + "T00:00:00Z"; }

  void addComment(pugi::xml_node parent, const BcfComment& comment)
  {
    pugi::xml_node node = parent.append_child("Comment");
    node.append_attribute("Guid") = comment.guid.c_str();
    addText(node, "Date", comment.date.empty() ? now() : comment.date);
    addText(node, "Author", comment.author);
    addText(node, "Comment", comment.text);
    addTextIfAny(node, "ModifiedDate", comment.modified_date);
    addTextIfAny(node, "ModifiedAuthor", comment.modified_author);
    users_.insert(comment.author);
  }

  void addViewpoint(pugi::xml_node parent, const char* name, const std::string& guid, bool has_picture)
  {
    pugi::xml_node node = parent.append_child(name);
    node.append_attribute("Guid") = guid.c_str();
    addText(node, "Viewpoint", "viewpoint.bcfv");
    if (has_picture) addText(node, "Snapshot", snapshot_file);
  }

  void addClash(const Clash& clash)
  {
    const std::string guid = bcfGuid(report_->idOf(clash)), viewpoint = bcfGuid(report_->idOf(clash) + "/viewpoint");
    const BcfTopic* const earlier = earlierOf(guid);
    pugi::xml_document document;
    pugi::xml_node markup = document.append_child("Markup");
    pugi::xml_node header = markup.append_child("Header");
    if (is_3_) header = header.append_child("Files");
    for (const std::string& file : {report_->question.input, report_->question.obstacle}) {
      pugi::xml_node node = header.append_child("File");
      node.append_attribute(is_3_ ? "IsExternal" : "isExternal") = true;
      addText(node, "Filename", fileName(file));
    }
    pugi::xml_node topic = markup.append_child("Topic");
    const std::string status = statusOf(clash, earlier);
    statuses_.insert(status);
    topic.append_attribute("Guid") = guid.c_str();
    topic.append_attribute("TopicType") = clash.wasNoClash() ? "Unseen" : "Clash";
    topic.append_attribute("TopicStatus") = xmlText(status).c_str();
    addText(topic, "Title", titleOf(clash));
    if (earlier) addTextIfAny(topic, "Priority", earlier->priority);
    if (is_3_)
      addText(topic.append_child("Labels"), "Label", nameOf(clash.status));
    else
      addText(topic, "Labels", nameOf(clash.status));
    const bool has_origin = earlier && !earlier->creation_date.empty() && !earlier->creation_author.empty();
    addText(topic, "CreationDate", has_origin ? earlier->creation_date : now());
    addText(topic, "CreationAuthor", has_origin ? earlier->creation_author : bcf_author);
    if (earlier) {
      addText(topic, "ModifiedDate", now());
      addText(topic, "ModifiedAuthor", bcf_author);
      addTextIfAny(topic, "DueDate", earlier->due_date);
      addTextIfAny(topic, "AssignedTo", earlier->assigned_to);
      addTextIfAny(topic, "Stage", earlier->stage);
      for (const auto& [set, text] :
           {std::pair{&priorities_, earlier->priority}, {&stages_, earlier->stage}, {&users_, earlier->assigned_to}})
        if (!text.empty()) set->insert(text);
    }
    addText(topic, "Description", descriptionOf(clash));
    addListReference(topic, bcfGuid(report_->idOf(clash) + "/list"));
    const auto parent = [&](const char* name) { return is_3_ ? topic.append_child(name) : markup; };
    if (earlier && !earlier->comments.empty()) {
      const pugi::xml_node comments = parent("Comments");
      for (const BcfComment& comment : earlier->comments) addComment(comments, comment);
    }
    const bool has_picture = drawsPictures() && report_->draws(clash) && pictures_++ < most_clash_pictures;
    addViewpoint(parent("Viewpoints"), is_3_ ? "ViewPoint" : "Viewpoints", viewpoint, has_picture);
    if (has_picture)
      files_[guid + '/' + snapshot_file] = pngOf(drawings_.picture(*report_, clash, titleOf(clash)), snapshot_pixels);
    files_[guid + "/markup.bcf"] = textOf(document);
    files_[guid + "/viewpoint.bcfv"] = viewpointOf(clash, viewpoint);
  }

  void addListReference(pugi::xml_node topic, const std::string& guid)
  {
    pugi::xml_node parent = is_3_ ? topic.append_child("DocumentReferences") : topic;
    pugi::xml_node reference = parent.append_child("DocumentReference");
    reference.append_attribute("Guid") = guid.c_str();
    if (!is_3_) reference.append_attribute("isExternal") = false;
    if (is_3_)
      addText(reference, "DocumentGuid", bcfGuid(bcf_list_file));
    else
      addText(reference, "ReferencedDocument", std::string("../") + bcf_list_file);
    addText(reference, "Description", "all clashes, for --previous");
  }

  /// Adds the names of the input and the obstacle. A name that is a GlobalId of IFC becomes the IfcGuid of its
  /// component, too.
  void addComponents(pugi::xml_node root, const Clash& clash)
  {
    std::string input = report_->question.input,
                obstacle = report_->name.empty() ? report_->question.obstacle : report_->name;
    if (isPresent(clash.status)) {
      if (report_->source_of) input = report_->source_of(clash.scan_point).file;
      if (report_->model_source_of) obstacle = report_->model_source_of(clash.model_point).file;
    }
    pugi::xml_node components = root.append_child("Components");
    pugi::xml_node selection = components.append_child("Selection");
    for (const std::string& name : {input, obstacle}) {
      pugi::xml_node component = selection.append_child("Component");
      const std::string stem = std::filesystem::path(name).stem().string();
      const bool is_id = stem.size() == 22 &&
                         stem.find_first_not_of("0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$") ==
                             std::string::npos;
      if (is_id) component.append_attribute("IfcGuid") = stem.c_str();
      addText(component, "OriginatingSystem", reportProgram());
      addText(component, "AuthoringToolId", fileName(name));
    }
    components.append_child("Visibility").append_attribute("DefaultVisibility") = true;
  }

  void addVector(pugi::xml_node parent, const char* name, const Vector3d& v)
  {
    pugi::xml_node node = parent.append_child(name);
    const char* axes[] = {"X", "Y", "Z"};
    for (Eigen::Index k = 0; k < 3; ++k) addText(node, axes[k], numberText(v[k]));
  }

  /// From above and aside, so far away that all of the clash is seen.
  std::string viewpointOf(const Clash& clash, const std::string& guid)
  {
    pugi::xml_document document;
    pugi::xml_node root = document.append_child("VisualizationInfo");
    root.append_attribute("Guid") = guid.c_str();
    addComponents(root, clash);
    const Vector3d low = ClashReport::vectorOf(clash.low), high = ClashReport::vectorOf(clash.high);
    const Vector3d middle = 0.5 * low + 0.5 * high, direction = Vector3d(1, 1, -1).normalized();
    const double away = 2 * std::max((high - low).norm(), report_->cluster_distance);
    pugi::xml_node camera = root.append_child("PerspectiveCamera");
    addVector(camera, "CameraViewPoint", metres_ * (middle - away * direction));
    addVector(camera, "CameraDirection", direction);
    addVector(camera, "CameraUpVector", Vector3d(1, 1, 2).normalized());
    addText(camera, "FieldOfView", "60");
    if (is_3_) addText(camera, "AspectRatio", "1");
    if (isPresent(clash.status)) {
      pugi::xml_node line = root.append_child("Lines").append_child("Line");
      addVector(line, "StartPoint", metres_ * report_->scanPoint(clash));
      addVector(line, "EndPoint", metres_ * report_->modelPoint(clash));
    }
    return textOf(document);
  }

  void addExtensions()
  {
    pugi::xml_document document;
    pugi::xml_node root = document.append_child("Extensions");
    const auto add = [&](const char* all, const char* one, const std::set<std::string>& texts) {
      pugi::xml_node node = root.append_child(all);
      for (const std::string& text : texts) addText(node, one, text);
    };
    std::set<std::string> labels;
    for (std::size_t i = 0; i < clash_statuses; ++i) labels.insert(nameOf(static_cast<ClashStatus>(i)));
    add("TopicTypes", "TopicType", {"Clash", "Unseen"});
    add("TopicStatuses", "TopicStatus", statuses_);
    add("Priorities", "Priority", priorities_);
    add("TopicLabels", "TopicLabel", labels);
    add("Users", "User", users_);
    add("SnippetTypes", "SnippetType", {});
    add("Stages", "Stage", stages_);
    files_["extensions.xml"] = textOf(document);
  }

  void addDocuments()
  {
    pugi::xml_document document;
    pugi::xml_node node = document.append_child("DocumentInfo").append_child("Documents").append_child("Document");
    node.append_attribute("Guid") = bcfGuid(bcf_list_file).c_str();
    addText(node, "Filename", bcf_list_file);
    files_["documents.xml"] = textOf(document);
    files_[bcfListDocument()] = clashJson(lists_);
  }

  const ClashLists& lists_;
  const ClashDrawings drawings_;
  std::size_t pictures_ = 0;
  const ClashReport* report_; ///< of the clash that is written
  bool is_3_;
  std::string date_;
  double metres_;
  ZipFiles files_;
  std::set<std::string> statuses_ = {open_topic, closed_topic}, priorities_, stages_, users_ = {bcf_author};
};

} // namespace

std::string clashBcf(const ClashLists& lists, bool is_version_3)
{
  return BcfArchive(lists, is_version_3).bytes();
}

} // namespace pcl_bsh::io
