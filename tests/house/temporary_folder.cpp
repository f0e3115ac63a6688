// Linked into every test program: each process has a temporary folder of its own, which goes with it. ctest
// runs tests of one program at the same time, and they write files of the same names.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

class OwnTemporaryFolder {
 public:
  OwnTemporaryFolder() : path_((std::filesystem::temp_directory_path() / "groundloop_test_XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr) {
      std::perror(path_.c_str());
      std::abort();
    }
    setenv("TMPDIR", path_.c_str(), 1);       // std::filesystem::temp_directory_path()
    setenv("TEST_TMPDIR", path_.c_str(), 1);  // testing::TempDir()
  }
  ~OwnTemporaryFolder() {
    std::error_code ignored;
    if (getpid() == owner_) std::filesystem::remove_all(path_, ignored);  // not a forked child
  }
  OwnTemporaryFolder(const OwnTemporaryFolder&) = delete;
  OwnTemporaryFolder& operator=(const OwnTemporaryFolder&) = delete;

 private:
  std::string path_;
  pid_t owner_ = getpid();
};

const OwnTemporaryFolder kOwnTemporaryFolder;

}  // namespace
