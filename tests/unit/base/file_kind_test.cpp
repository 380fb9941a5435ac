#include "engine/base/file_kind.hpp"

#include <doctest/doctest.h>

#include "engine/base/diagnostic.hpp"

using namespace abbe;

TEST_CASE("the kind of a file by its first lines") {
  CHECK(kind_of("\xEF\xBB\xBF\n{\"schema\": \"abbe.machine/1\"}") == FileKind::json);
  CHECK(kind_of("# machine: mine\nFeature; X [mm]; Y [mm]\n") == FileKind::table);
  CHECK(kind_of("# measured on Monday\r\n\r\nfeature,touch,x,y,z\r\n") == FileKind::table);
  CHECK(kind_of("\"time_s\"\t\"x\"\n") == FileKind::table);
  CHECK(kind_of("UNITS/MM,ANGDEC\ndmismn/'part',5.2\n") == FileKind::program);
  CHECK(kind_of("$$ a drawing: feature, x\nGOTO/1,2,3\n") == FileKind::program);
  CHECK(kind_of("DMISMN/'part',5.2\nFA(BORE) = FEAT/CIRCLE\n") == FileKind::result);
}

TEST_CASE("what is not known is left to its reader") {
  for (const char* text : {"", "\n\n", "GOTO/1,2,3\n", "DECL/REAL,X,Y,VALUE\n", "name,1,2,3\nFA(BORE),1,2,3\n",
                           "# no key\nname;1;2\n", "x\n", "hello"})
    CHECK(kind_of(text) == FileKind::unknown);
  CHECK_NOTHROW(refuse_other_kind(SourceFile("a", "GOTO/1,2,3\n"), FileKind::table));
  CHECK_THROWS_AS(refuse_other_kind(SourceFile("a", "$$\n"), FileKind::table), UserError);
}
