#include "Arrays.hpp"

#include "epafi/base/ParameterValue.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_Core.hpp>

#include <bit>

namespace epafi::python {
namespace {

template <class T>
py::object listOf(const Teuchos::ParameterEntry& entry) {
  const auto& array = Teuchos::getValue<Teuchos::Array<T>>(entry);
  py::list list;
  for (const T& value : array)
    list.append(value);
  return list;
}

py::object valueOf(const Teuchos::ParameterEntry& entry) {
  if (entry.isType<int>())
    return py::int_(Teuchos::getValue<int>(entry));
  if (entry.isType<GlobalOrdinal>())
    return py::int_(Teuchos::getValue<GlobalOrdinal>(entry));
  if (entry.isType<double>())
    return py::float_(Teuchos::getValue<double>(entry));
  if (entry.isType<bool>())
    return py::bool_(Teuchos::getValue<bool>(entry));
  if (entry.isType<std::string>())
    return py::str(Teuchos::getValue<std::string>(entry));
  if (entry.isType<Teuchos::Array<int>>())
    return listOf<int>(entry);
  if (entry.isType<Teuchos::Array<double>>())
    return listOf<double>(entry);
  return py::str(valueText(entry));
}

} // namespace

py::dict dictOf(const Teuchos::ParameterList& list) {
  py::dict dict;
  for (auto item = list.begin(); item != list.end(); ++item) {
    const Teuchos::ParameterEntry& entry = list.entry(item);
    dict[py::str(list.name(item))] =
        entry.isList() ? py::object(dictOf(Teuchos::getValue<Teuchos::ParameterList>(entry)))
                       : valueOf(entry);
  }
  return dict;
}

py::dict schemaOf(const Teuchos::ParameterList& schema) {
  py::dict dict;
  for (auto item = schema.begin(); item != schema.end(); ++item) {
    const Teuchos::ParameterEntry& entry = schema.entry(item);
    py::object value;
    if (!entry.isList()) {
      value = py::make_tuple(typeName(entry), valueText(entry), entry.docString());
    } else {
      value = schemaOf(Teuchos::getValue<Teuchos::ParameterList>(entry));
      value[py::str("")] = entry.docString();
    }
    dict[py::str(schema.name(item))] = value;
  }
  return dict;
}

RCP<const Comm> communicator(std::uintptr_t address) {
  if (address == 0)
    return Tpetra::getDefaultComm();
  return rcp(new Teuchos::MpiComm<int>(*std::bit_cast<const MPI_Comm*>(address)));
}

} // namespace epafi::python
