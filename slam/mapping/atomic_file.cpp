#include "slam/mapping/atomic_file.h"

#include <filesystem>
#include <fstream>

#include "slam/types/config.h"

namespace groundloop::slam {

void write_file_atomically(const std::string& file, const std::function<void(std::ostream&)>& write) {
  const std::string temporary = file + ".partial";
  const auto fail = [&](const char* what) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw InputError(Problem{file, 0, "", what, "a file that can be written"});
  };
  std::ofstream out(temporary, std::ios::binary);
  if (!out) fail("cannot be created");
  write(out);
  out.close();
  if (!out) fail("cannot be written to its end");
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (error) fail("cannot be named");
}

}  // namespace groundloop::slam
