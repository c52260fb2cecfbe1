#pragma once

/// What a schema entry allows beyond its type. Teuchos's own validators let NaN pass, know no open intervals,
/// and their header is no valid C++20.

#include <Teuchos_ParameterEntryValidator.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace epafi {

/// A validator that can say in words what it allows.
class AllowedValues : public Teuchos::ParameterEntryValidator {
public:
  [[nodiscard]] virtual bool admits(const Teuchos::ParameterEntry& entry) const = 0;
  /// What is allowed, to follow the words "must be"; empty if everything finite is.
  [[nodiscard]] virtual std::string allowed() const = 0;

  // NOLINTNEXTLINE(readability-const-return-type): Teuchos declares it so
  [[nodiscard]] const std::string getXMLTypeName() const override { return "EpafiAllowedValues"; }
  [[nodiscard]] ValidStringsList validStringValues() const override { return Teuchos::null; }
  void printDoc(const std::string& docString, std::ostream& out) const override;
  /// \throws InputError if the value is not allowed.
  void validate(const Teuchos::ParameterEntry& entry, const std::string& parameter,
                const std::string& list) const override;
};

/// An int or double between minimum and maximum; an end that is open is not allowed itself. Never NaN or
/// infinite.
class Range final : public AllowedValues {
public:
  Range(double minimum, double maximum, bool openBelow, bool openAbove)
      : minimum_(minimum), maximum_(maximum), openBelow_(openBelow), openAbove_(openAbove) {}
  [[nodiscard]] bool admits(const Teuchos::ParameterEntry& entry) const override;
  [[nodiscard]] std::string allowed() const override;

private:
  double minimum_, maximum_;
  bool openBelow_, openAbove_;
};

/// A double in a range, or one of a few words in its place.
class RealOrWord final : public AllowedValues {
public:
  RealOrWord(Range range, const std::vector<std::string>& words) : range_(std::move(range)), words_(words) {}
  [[nodiscard]] bool admits(const Teuchos::ParameterEntry& entry) const override;
  [[nodiscard]] std::string allowed() const override;

private:
  Range range_;
  std::vector<std::string> words_;
};

/// A double in [0, 1), or a string of per cents in its place.
class Share final : public AllowedValues {
public:
  [[nodiscard]] bool admits(const Teuchos::ParameterEntry& entry) const override;
  [[nodiscard]] std::string allowed() const override { return "≥ 0 and < 1, or per cents such as \"1 %\""; }
  /// The number that a text of per cents means; nothing if it is none.
  [[nodiscard]] static std::optional<double> parsed(const std::string& text);
};

/// One word out of a few.
class Choice final : public AllowedValues {
public:
  explicit Choice(const std::vector<std::string>& words);
  [[nodiscard]] bool admits(const Teuchos::ParameterEntry& entry) const override;
  [[nodiscard]] std::string allowed() const override;
  [[nodiscard]] ValidStringsList validStringValues() const override { return words_; }

private:
  ValidStringsList words_;
};

/// Says what is allowed, and leaves the check to who reads the parameter.
class Remark final : public AllowedValues {
public:
  explicit Remark(std::string allowed) : allowed_(std::move(allowed)) {}
  [[nodiscard]] bool admits(const Teuchos::ParameterEntry&) const override { return true; }
  [[nodiscard]] std::string allowed() const override { return allowed_; }

private:
  std::string allowed_;
};

/// Marks a parameter that must be given; what it may be, `inner` says.
class Required final : public AllowedValues {
public:
  /// \param inner  may be null
  explicit Required(Teuchos::RCP<const AllowedValues> inner) : inner_(std::move(inner)) {}
  [[nodiscard]] bool admits(const Teuchos::ParameterEntry& entry) const override {
    return inner_.is_null() || inner_->admits(entry);
  }
  [[nodiscard]] std::string allowed() const override { return inner_.is_null() ? "" : inner_->allowed(); }
  [[nodiscard]] ValidStringsList validStringValues() const override {
    return inner_.is_null() ? Teuchos::null : inner_->validStringValues();
  }

private:
  Teuchos::RCP<const AllowedValues> inner_;
};

} // namespace epafi
