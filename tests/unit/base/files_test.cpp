#include "engine/base/files.hpp"

#include <doctest/doctest.h>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

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

TEST_CASE("a program that is ended while it writes leaves whole files and nothing beside them") {
  const std::filesystem::path folder = "files_test_ended";
  std::filesystem::create_directory(folder);
  const std::string content(8 << 20, 'x');
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    const pid_t writer = fork();
    if (writer == 0)
      for (;;) write_whole((folder / "file").string(), content);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    kill(writer, signal);
    int status = 0;
    REQUIRE(waitpid(writer, &status, 0) == writer);
    CHECK((WIFSIGNALED(status) && WTERMSIG(status) == signal));
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    CHECK(entry.path().filename() == "file");
    CHECK(entry.file_size() == content.size());
  }
  std::filesystem::remove_all(folder);
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

TEST_CASE("several files are written all or none") {
  write_whole("files_test_one", "before");
  write_together({{"files_test_one", "after"}, {"files_test_two", "new"}});
  CHECK(read_source("files_test_one").text() == "after");
  CHECK(read_source("files_test_two").text() == "new");
  std::remove("files_test_two");
  for (const char* impossible : {"/dev/full", "no/such/folder/file", "."}) {
    CHECK_THROWS_AS(write_together({{"files_test_one", "changed"}, {"files_test_two", "new"}, {impossible, "x"}}),
                    UserError);
    CHECK(read_source("files_test_one").text() == "after");
    CHECK_FALSE(std::filesystem::exists("files_test_two"));
  }
  const auto unprinted = [] { throw UserError(diagnostic(Code::E0602, "no")); };
  CHECK_THROWS_AS(write_together({{"files_test_one", "changed"}, {"files_test_two", "new"}}, unprinted), UserError);
  CHECK(read_source("files_test_one").text() == "after");
  CHECK_FALSE(std::filesystem::exists("files_test_two"));
  for (const auto& entry : std::filesystem::directory_iterator("."))
    CHECK(entry.path().filename().string().rfind("files_test_one.", 0) == std::string::npos);
  std::remove("files_test_one");
  CHECK_THROWS_AS(refuse_overwriting({}, {"."}), UserError);
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

TEST_CASE("what is no file is written into, and a link stays") {
  REQUIRE(mkfifo("files_test_pipe", 0600) == 0);
  std::string came;
  std::thread reader([&] {
    std::ifstream pipe("files_test_pipe");
    std::getline(pipe, came);
  });
  write_whole("files_test_pipe", "through\n");
  reader.join();
  CHECK(came == "through");
  std::remove("files_test_pipe");
  std::filesystem::create_symlink("files_test_end", "files_test_link");
  for (const char* text : {"made", "replaced"}) {
    write_whole("files_test_link", text);
    CHECK(std::filesystem::is_symlink("files_test_link"));
    CHECK(read_source("files_test_end").text() == text);
  }
  std::remove("files_test_link");
  std::remove("files_test_end");
}

TEST_CASE("a file keeps its permissions, a new one has those of the umask, and a read-only one stays") {
  const std::filesystem::path path = "files_test_mode";
  std::filesystem::remove(path);
  const auto mode = [&] { return static_cast<unsigned>(std::filesystem::status(path).permissions()); };
  const mode_t before = ::umask(027);
  write_whole(path, "new");
  ::umask(before);
  CHECK(mode() == 0640);
  for (const unsigned kept : {0600u, 0664u}) {
    std::filesystem::permissions(path, static_cast<std::filesystem::perms>(kept));
    write_whole(path, "kept");
    CHECK(mode() == kept);
  }
  std::filesystem::permissions(path, static_cast<std::filesystem::perms>(0444));
  CHECK_THROWS_AS(write_whole(path, "gone"), UserError);
  CHECK_THROWS_AS(refuse_overwriting({}, {path}), UserError);
  CHECK(read_source(path).text() == "kept");
  std::filesystem::remove(path);
}

TEST_CASE("no output is an input or another output, whatever they are called") {
  const auto refused = [](const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
    try {
      refuse_overwriting(inputs, outputs);
    } catch (const UserError& error) {
      return error.diagnostics()[0].code == Code::E0616;
    }
    return false;
  };
  write_whole("files_test_in", "x");
  std::filesystem::create_symlink("files_test_in", "files_test_link");
  CHECK(refused({"files_test_in"}, {"./files_test_in"}));
  CHECK(refused({"files_test_in"}, {"files_test_link"}));
  CHECK(refused({}, {"files_test_out", "./files_test_out"}));
  REQUIRE(mkfifo("files_test_pipe", 0600) == 0);
  CHECK_FALSE(refused({"files_test_in"}, {"files_test_out", "files_test_pipe", "files_test_pipe"}));
  std::remove("files_test_pipe");
  std::remove("files_test_link");
  std::remove("files_test_in");
}

TEST_CASE("text that is not UTF-8 is read as Windows-1252, aloud") {
  const auto read = [](std::string_view bytes, Sink& sink) {
    write_whole("files_test_text", bytes);
    return std::string(read_text("files_test_text", sink).text());
  };
  Sink good, other;
  for (const char* text : {"plain",
                           "Gr\xC3\xB6\xC3\x9F"
                           "e \xE2\x82\xAC \xF0\x9F\x98\x80"})
    CHECK(read(text, good) == text);
  CHECK(good.list().empty());
  CHECK(read("one\nGr\xF6\xDF"
             "e \x80 \x96",
             other) ==
        "one\nGr\xC3\xB6\xC3\x9F"
        "e \xE2\x82\xAC \xE2\x80\x93");
  REQUIRE(other.list().size() == 1);
  CHECK(other.list()[0].code == Code::N0617);
  CHECK(other.list()[0].message.find("files_test_text:2") != std::string::npos);
  for (const char* no_utf8 : {"\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xC3", "\x80"}) {
    Sink sink;
    read(no_utf8, sink);
    CHECK(sink.list().size() == 1);
  }
  CHECK_THROWS_AS(read(std::string_view("\xFF\xFE"
                                        "a\0",
                                        4),
                       other),
                  UserError);  // E0618
  std::remove("files_test_text");
}

}  // namespace abbe
