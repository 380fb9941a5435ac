#include "engine/base/files.hpp"

#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>

#include "engine/base/diagnostic.hpp"
#include "engine/base/source.hpp"

namespace abbe {

TEST_CASE("a file is written whole and read back") {
  const std::string path = "files_test.txt";
  write_whole(path, "first");
  write_whole(path, "second\n");
  CHECK(read_source(path).text() == "second\n");
  CHECK(read_source(path).name() == path);
  std::remove(path.c_str());
}

TEST_CASE("a file that cannot be written says so and leaves nothing behind") {
  const std::string folder = "files_test_folder";
  std::filesystem::create_directory(folder);
  try {
    write_whole(folder, "x");  // a folder stands in the way
    FAIL("a folder was overwritten");
  } catch (const UserError& error) {
    CHECK(error.diagnostics()[0].code == Code::E0602);
    CHECK(error.diagnostics()[0].message.find(folder) != std::string::npos);
  }
  std::filesystem::remove(folder);
  for (const auto& entry : std::filesystem::directory_iterator("."))
    CHECK(entry.path().filename().string().rfind("files_test_folder.", 0) == std::string::npos);
  CHECK_THROWS_AS(write_whole("no/such/folder/file", "x"), UserError);
}

TEST_CASE("a file that cannot be read says why") {
  try {
    read_source("no such file.dmi");
    FAIL("a file that does not exist was read");
  } catch (const UserError& error) {
    CHECK(error.diagnostics()[0].code == Code::E0601);
    CHECK(error.diagnostics()[0].message.find("no such file.dmi") != std::string::npos);
    CHECK(error.diagnostics()[0].message.find("No such file or directory") != std::string::npos);
  }
  CHECK_THROWS_AS(read_source("."), UserError);
}

}  // namespace abbe
