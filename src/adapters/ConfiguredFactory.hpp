#pragma once

/// How Epafi's factories take parameters, as all of Thyra's do.

#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/base/Types.hpp"

#include <Teuchos_VerboseObjectParameterListHelpers.hpp>

#include <string>
#include <utility>

namespace epafi::adapters {

/// Parameters::validParameters, and the list "VerboseObject".
template <class Factory, class Parameters>
class ConfiguredFactory : public Factory {
public:
  /// \throws InputError that names list, parameter, value and what is allowed
  void setParameterList(const RCP<Teuchos::ParameterList>& list) override {
    if (list.is_null())
      throw InputError("a " + name_ +
                       " factory was given no parameter list; an empty one stands for the defaults");
    parameters_ = Parameters::from(validated(*list, *getValidParameters(), ""));
    list_ = list;
    Teuchos::readVerboseObjectSublist(&*list_, this);
  }
  [[nodiscard]] RCP<Teuchos::ParameterList> getNonconstParameterList() override { return list_; }
  [[nodiscard]] RCP<Teuchos::ParameterList> unsetParameterList() override {
    parameters_ = {};
    return std::exchange(list_, Teuchos::null);
  }
  [[nodiscard]] RCP<const Teuchos::ParameterList> getParameterList() const override { return list_; }
  [[nodiscard]] RCP<const Teuchos::ParameterList> getValidParameters() const override {
    static const RCP<const Teuchos::ParameterList> valid = [] {
      RCP<Teuchos::ParameterList> list = rcp(new Teuchos::ParameterList(Parameters::validParameters()));
      Teuchos::setupVerboseObjectSublist(&*list);
      return list;
    }();
    return valid;
  }
  [[nodiscard]] std::string description() const override { return "Epafi " + name_; }

protected:
  explicit ConfiguredFactory(std::string name) : name_(std::move(name)) {}
  [[nodiscard]] const Parameters& parameters() const { return parameters_; }

private:
  std::string name_;
  RCP<Teuchos::ParameterList> list_;
  Parameters parameters_;
};

} // namespace epafi::adapters
