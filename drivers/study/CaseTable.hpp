#pragma once

/// Cases of the studies as data: text in which scenes, and sweeps over them, are written down.
///
///     scene NAME PARAMETER=DEFAULT …      a piece of a case that others use, with what follows indented
///     family NAME                         cases that belong together
///       for A,B in 1,x 2,y names and their values; with ; between them values may contain blanks.
///                                         Commas followed by a blank belong to the text
///       for A from 0 to 3 step 1
///       let A = VALUE                     (VALUE) in parentheses is computed
///       if CONDITION
///       case NAME; PARAMETER; VALUE       one row; VALUE, a number, and PARAMETER may be missing
///         use NAME PARAMETER=VALUE …      what the scene says
///         LIST/SUB LIST/PARAMETER = VALUE a number, which may be computed, {numbers}, or words. * as a list
///         stands for all
///                                         that are there
///         remove LIST/SUB LIST
///         reference                       what follows makes the list Reference, a case to compare with
///
/// $A stands for A's value, anywhere; QUICK | FULL in `for` and `let` for values of quick and of full runs; #
/// begins a comment.

#include <Teuchos_ParameterList.hpp>

#include <limits>
#include <string>
#include <vector>

namespace epafi::drivers {

struct Case {
  std::string family, name, parameter;
  double value = std::numeric_limits<double>::quiet_NaN(); ///< NaN if none is given
  Teuchos::ParameterList list = {};                        ///< what it says

  /// The lists of a scene file alone.
  [[nodiscard]] Teuchos::ParameterList scene() const;
};

/// The cases of a family of a text, or of all in their order if `family` is empty.
/// \param text  with the scenes that are used
/// \throws InputError with the line if the text is not as above
std::vector<Case> expandCases(const std::string& text, const std::string& family, bool quick);

/// Such a text, which comes with the program: cases/scenes.cases and, after them, the named file.
const std::string& caseText(const std::string& file);

} // namespace epafi::drivers
