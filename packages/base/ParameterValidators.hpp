#pragma once

/// What a schema entry allows beyond its type. Teuchos's own validators let NaN pass, know no open intervals,
/// and their header is no valid C++20.

#include <Teuchos_ParameterEntry.hpp>
#include <Teuchos_ParameterEntryValidator.hpp>

#include <functional>
#include <optional>
#include <string>

namespace epafi {

/// A validator that can say in words what it allows.
struct AllowedValues final : Teuchos::ParameterEntryValidator {
  std::function<bool(const Teuchos::ParameterEntry&)> admits; ///< null: all
  std::string text; ///< what is allowed, to follow the words "must be"; empty if everything finite is
  ValidStringsList words = Teuchos::null; ///< that the value may be, of a parameter that is a word
  bool takesWords = false;                ///< whether a string may stand in the place of a number
  bool isShare = false;                   ///< whether that may be per cents
  bool isRequired = false;                ///< whether the parameter must be given

  // NOLINTNEXTLINE(readability-const-return-type): Teuchos declares it so
  [[nodiscard]] const std::string getXMLTypeName() const override { return "EpafiAllowedValues"; }
  [[nodiscard]] ValidStringsList validStringValues() const override { return words; }
  void printDoc(const std::string& docString, std::ostream& out) const override;
  /// \throws InputError if the value is not allowed.
  void validate(const Teuchos::ParameterEntry& entry, const std::string& parameter,
                const std::string& list) const override;
};

/// Null where the schema says nothing but the type, or has a validator of somebody else's.
inline const AllowedValues* allowedValues(const Teuchos::ParameterEntry& schemaEntry) {
  return dynamic_cast<const AllowedValues*>(schemaEntry.validator().get());
}

/// The number that a text of per cents means; nothing if it is none.
std::optional<double> shareFrom(const std::string& text);

} // namespace epafi
