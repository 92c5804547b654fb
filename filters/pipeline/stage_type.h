// SPDX-License-Identifier: BSD-3-Clause
// The table of stages: from it come the parser's checks, the JSON schema and the documentation.
//
//   const bool registered = pcl_bsh::pipeline::registerStage(
//       pcl_bsh::pipeline::describe<EveryNth>("filters.every_nth", "Keeps one point of every few.")
//           .option(&EveryNth::step, "step", "keep one of so many points").atLeast(1));
//
// With that line in a program, its pipelines know {"type": "filters.every_nth", "step": 10}.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/pipeline/option_type.h>
#include <pcl_bsh/filters/pipeline/stage.h>

#include <cstddef>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::pipeline {

/// A row of a stage's options.
struct Option {
  std::string name;
  Kind kind;
  std::string doc;
  std::string unit; ///< of numbers; empty: none
  Value standard;   ///< when the document says nothing
  bool required = false;
  bool nullable = false; ///< null means that nothing is said
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;         ///< `least` itself is not allowed
  std::vector<std::string> choices; ///< of a text; empty: any
  bool replaceable = false;         ///< an input file that an output of the same stage may replace
  std::vector<Option> of_rows;      ///< of kind rows: the options of each row
  bool of_reader = false;           ///< of a row: the reader of the row's file has it

  std::function<void(Stage&, const Value&)> set;
  std::function<Value(const Stage&)> get;
  std::function<OtherCloud*(Stage&, std::size_t row)> cloud; ///< of kind cloud or rows; row 0 where there are none
};

/// A row of the table of stages.
struct StageType {
  std::string name;                 ///< readers.x, filters.x or writers.x
  std::vector<std::string> aliases; ///< PCL's name of the class
  std::string doc;
  std::size_t least_inputs = 1;
  std::size_t most_inputs = 1;
  std::vector<std::string> extensions; ///< of files whose mere name in a document stands for this stage
  std::vector<Option> options;
  std::function<std::unique_ptr<Stage>()> make;

  bool isReader() const { return most_inputs == 0; }               ///< takes no cloud
  bool isWriter() const { return name.rfind("writers.", 0) == 0; } ///< ends in a file
  const Option* findOption(const std::string& option) const;       ///< by name; null where no option has it

  /// Adds an option; its standard becomes the value in a new stage. Not inline: GCC 12 sees a Value free what it never
  /// held.
  void addOption(Option option);
};

/// Fills in a StageType. Each option() adds a member of S: the member's type and initial value are those of the option.
/// The calls that follow it refine it.
template <typename S>
class StageDescription {
public:
  /// A name that begins with readers. takes no inputs; others take one, unless inputs() says otherwise.
  StageDescription(std::string name, std::string doc)
  {
    type_.name = std::move(name);
    type_.doc = std::move(doc);
    if (type_.name.rfind("readers.", 0) == 0) type_.least_inputs = type_.most_inputs = 0;
    type_.make = [] { return std::make_unique<S>(); };
  }

  /// Another name for the stage: that of PCL's class.
  StageDescription& alias(std::string name)
  {
    type_.aliases.push_back(std::move(name));
    return *this;
  }

  /// How many clouds it takes.
  StageDescription& inputs(std::size_t least, std::size_t most)
  {
    type_.least_inputs = least;
    type_.most_inputs = most;
    return *this;
  }

  /// Extensions of files whose mere name in a document stands for this stage; with the dot.
  StageDescription& extensions(std::vector<std::string> extensions)
  {
    type_.extensions = std::move(extensions);
    return *this;
  }

  /// A member of the stage that documents may set. @param doc one sentence
  template <typename T, typename Base>
  StageDescription& option(T Base::*member, std::string name, std::string doc)
  {
    static_assert(std::is_base_of_v<Base, S>, "an option is a member of the stage");
    Option option;
    option.name = std::move(name);
    option.doc = std::move(doc);
    option.kind = OptionType<T>::kind;
    option.least = NumberLimits<T>::least;
    option.most = NumberLimits<T>::most;
    option.set = [member](Stage& stage, const Value& value) {
      static_cast<S&>(stage).*member = OptionType<T>::from(value);
    };
    option.get = [member](const Stage& stage) { return OptionType<T>::to(static_cast<const S&>(stage).*member); };
    if constexpr (std::is_same_v<T, OtherCloud>)
      option.cloud = [member](Stage& stage, std::size_t) { return &(static_cast<S&>(stage).*member); };
    if constexpr (std::is_same_v<T, std::optional<OtherCloud>>)
      option.cloud = [member](Stage& stage, std::size_t) { return &*(static_cast<S&>(stage).*member); };
    type_.addOption(std::move(option));
    return *this;
  }

  /// Adds an option that is made already; its `set` and `get` are for stages of type S.
  StageDescription& option(Option option)
  {
    type_.addOption(std::move(option));
    return *this;
  }

  /// Sets the last option's unit: its number counts these.
  StageDescription& unit(std::string unit)
  {
    last().unit = std::move(unit);
    return *this;
  }
  /// Makes the last option a length above 0, in metres.
  StageDescription& positiveLength() { return unit("m").above(0); }
  /// Makes the last option required in a document.
  StageDescription& required()
  {
    last().required = true;
    last().nullable = false;
    return *this;
  }
  /// Sets a limit of the last option: > least.
  StageDescription& above(double least)
  {
    last().above_least = true;
    return atLeast(least);
  }
  /// Sets a limit of the last option: >= least.
  StageDescription& atLeast(double least)
  {
    last().least = least;
    return *this;
  }
  /// Sets a limit of the last option: <= most.
  StageDescription& atMost(double most)
  {
    last().most = most;
    return *this;
  }
  /// Sets the texts that the last option may have.
  StageDescription& choices(std::vector<std::string> choices)
  {
    last().choices = std::move(choices);
    return *this;
  }

  /// Lets an output of the same stage replace the last option's input file, as plan() has read it by then.
  StageDescription& replaceable()
  {
    last().replaceable = true;
    return *this;
  }

  /// The argument of registerStage().
  operator StageType() const { return type_; } // NOLINT: a description is a stage type, once it is complete

private:
  Option& last() { return type_.options.back(); }

  StageType type_;
};

/// Begins the description of stage S. @param name readers.x, filters.x or writers.x @param doc one sentence
template <typename S>
StageDescription<S> describe(std::string name, std::string doc)
{
  return {std::move(name), std::move(doc)};
}

/// Adds a row to the table of this program. To be called before pipelines are read.
/// @return true, so that a global variable can be initialised with it
/// @throws std::invalid_argument when the name or an alias is taken, or begins with neither readers., filters. nor
///   writers., or an option is named as a key that every stage has
bool registerStage(StageType type);

/// The table: what the library brings, then what registerStage() added.
const std::deque<StageType>& stageTypes();

/// By name or alias; null where no stage has it.
const StageType* findStageType(const std::string& name);

} // namespace pcl_bsh::pipeline
PCL_BSH_EXPORT_END
