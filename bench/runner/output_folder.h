#pragma once

#include <string>

namespace groundloop::bench {

/// A folder that appears under its name only when it is complete. Until then everything is written beside it,
/// under a temporary name, which is removed when the work does not come to its end.
class OutputFolder {
 public:
  /// @throws InputError when the place cannot be written, or holds something that is not a run folder
  explicit OutputFolder(const std::string& destination);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write.
  const std::string& path() const { return temporary_; }
  std::string file(const std::string& name) const { return temporary_ + "/" + name; }

  /// Gives the folder its name; an older run of that name is replaced.
  void publish();

 private:
  std::string destination_;
  std::string temporary_;
  bool published_ = false;
};

}  // namespace groundloop::bench
