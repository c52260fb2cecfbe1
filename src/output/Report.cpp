#include "epafi/output/Report.hpp"

#include "epafi/output/AtomicFile.hpp"

#include <Teuchos_XMLParameterListHelpers.hpp>

#include <sstream>

namespace epafi::output {

void writeReport(const Teuchos::ParameterList& report, const std::filesystem::path& file, const Comm& comm) {
  writeTextFile(
      file,
      [&] {
        std::ostringstream text;
        Teuchos::writeParameterListToXmlOStream(report, text);
        return text.str();
      },
      comm);
}

} // namespace epafi::output
