#!/usr/bin/env python3
"""abbe lsp: the language server, driven over its standard streams as an editor does it."""
import json
import subprocess
import urllib.parse

import harness
from harness import LENGTH

URI = "file:///parts/a%20length.dmi"


class Server:
    def __init__(self, path):
        self.process = subprocess.Popen([path, "lsp", "--stdio"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.number = 0

    def send(self, message):
        data = message if isinstance(message, bytes) else json.dumps(message).encode()
        self.process.stdin.write(b"Content-Length: %d\r\nContent-Type: x\r\n\r\n" % len(data) + data)
        self.process.stdin.flush()

    def receive(self):
        length = None
        while (line := self.process.stdout.readline().strip()):
            name, value = line.split(b":")
            length = int(value) if name == b"Content-Length" else length
        return json.loads(self.process.stdout.read(length))

    def notify(self, method, params):
        self.send({"jsonrpc": "2.0", "method": method, "params": params})

    def request(self, method, params=None):
        self.number += 1
        self.send({"jsonrpc": "2.0", "id": self.number, "method": method, "params": params or {}})
        answer = self.receive()
        assert answer["id"] == self.number, answer
        return answer

    def close(self):
        """Ends the input; the exit code of the server."""
        self.process.stdin.close()
        self.process.stdout.close()
        return self.process.wait(timeout=20)


class Lsp(harness.Case):
    def setUp(self):
        super().setUp()
        self.server = Server(self.abbe_path)
        self.addCleanup(self.server.close)
        self.capabilities = self.server.request("initialize", {"capabilities": {}})["result"]["capabilities"]
        self.server.notify("initialized", {})

    def open(self, text, uri=URI):
        self.text, self.uri = text, uri
        self.server.notify("textDocument/didOpen", {"textDocument": {"uri": uri, "languageId": "dmis", "version": 1, "text": text}})
        published = self.server.receive()
        self.assertEqual(published["method"], "textDocument/publishDiagnostics")
        self.assertEqual(published["params"]["uri"], uri)
        return published["params"]["diagnostics"]

    def open_beside(self, text, **modules):
        """Opens a program that lies beside these modules."""
        for name, module in modules.items():
            self.write(name + ".dmi", module)
        return self.open(text, self.uri_of("a program.dmi"))

    def uri_of(self, name):
        return "file://" + urllib.parse.quote(str(self.folder / name))

    def place(self, piece, shift=0, nth=0):
        """The position `shift` UTF-16 units behind the beginning of the nth occurrence of a piece of the text."""
        at = -1
        for _ in range(nth + 1):
            at = self.text.index(piece, at + 1)
        before = self.text[:at]
        line = before.count("\n")
        units = len(before[before.rfind("\n") + 1:].encode("utf-16-le")) // 2
        return {"line": line, "character": units + shift}

    def ask(self, question, place=None, **more):
        return self.answer(question, place, **more)["result"]

    def answer(self, question, place=None, **more):
        params = {"textDocument": {"uri": self.uri}, **more}
        if place:
            params["position"] = place
        return self.server.request("textDocument/" + question, params)

    def hover(self, place):
        answer = self.ask("hover", place)
        return answer and answer["contents"]["value"]

    def pieces(self, ranges):
        """What stands at these ranges."""
        lines = [line.encode("utf-16-le") for line in self.text.split("\n")]
        return [lines[r["start"]["line"]][2 * r["start"]["character"]:2 * r["end"]["character"]].decode("utf-16-le") for r in ranges]

    def rename(self, place, name):
        """The program with the new name."""
        edits = self.ask("rename", place, newName=name)["changes"][self.uri]
        lines = [line.encode("utf-16-le") for line in self.text.split("\n")]
        for edit in sorted(edits, key=lambda e: (e["range"]["start"]["line"], -e["range"]["start"]["character"])):
            begin, end = edit["range"]["start"], edit["range"]["end"]
            line = lines[begin["line"]]
            lines[begin["line"]] = line[:2 * begin["character"]] + edit["newText"].encode("utf-16-le") + line[2 * end["character"]:]
        return "\n".join(line.decode("utf-16-le") for line in lines)

    def test_messages_as_you_type_and_their_quick_fixes(self):
        wrong = LENGTH.replace("SNSLCT/S(P)", "SNSLCTT/S(P)").replace("OUTPUT/FA(A)", "OUTPUT/FA(AA)")
        found = self.open("$$ \u00e4 \U0001f4d0\n" + wrong)
        first = found[0]
        self.assertEqual((first["code"], first["severity"], first["source"]), ("E0110", 1, "abbe"))
        self.assertIn("did you mean SNSLCT?", first["message"])
        self.assertEqual(first["range"], {"start": self.place("SNSLCTT"), "end": self.place("SNSLCTT", 7)})
        actions = self.ask("codeAction", range=first["range"], context={"diagnostics": [first]})
        self.assertEqual([a["title"] for a in actions], ["Write SNSLCT"])
        edit = actions[0]["edit"]["changes"][URI][0]
        self.assertEqual(edit, {"range": first["range"], "newText": "SNSLCT"})
        self.server.notify("textDocument/didChange", {"textDocument": {"uri": URI, "version": 2}, "contentChanges": [{"text": LENGTH}]})
        self.assertEqual(self.server.receive()["params"]["diagnostics"], [])
        self.server.notify("textDocument/didClose", {"textDocument": {"uri": URI}})
        self.assertEqual(self.server.receive()["params"]["diagnostics"], [])

    def test_places_count_utf16_units(self):
        text = LENGTH.replace("F(A)", "F(\u00c4\U0001f4d0)").replace("FA(A)", "FA(\u00c4\U0001f4d0)")
        self.open(text)
        use = self.ask("definition", self.place("TA(LEN)", 3))
        self.assertEqual(use["range"], {"start": self.place("T(LEN)"), "end": self.place("T(LEN)", 6)})
        label = self.ask("definition", self.place("FA(\u00c4", 4))
        self.assertEqual(label["range"], {"start": self.place("F(\u00c4"), "end": self.place("F(\u00c4", 6)})

    def test_definition_and_references(self):
        self.open(LENGTH + "$$ end")
        self.assertEqual(self.ask("definition", self.place("FA(B)", 4))["range"]["start"], self.place("F(B)=FEAT"))
        uses = self.ask("references", self.place("F(A)=FEAT", 1), context={"includeDeclaration": True})
        self.assertEqual([u["range"]["start"] for u in uses], [self.place("F(A)=FEAT"), self.place("F(A),1"), self.place("FA(A)")])
        uses = self.ask("references", self.place("F(A)=FEAT", 1), context={"includeDeclaration": False})
        self.assertEqual(len(uses), 2)
        self.assertIsNone(self.ask("definition", self.place("UNITS")))

    def test_hover(self):
        self.open(LENGTH)
        word = self.ask("hover", self.place("PTMEAS", 2))["contents"]["value"]
        self.assertIn("PTMEAS/", word)
        self.assertIn("Touches the surface", word)
        self.assertIn("distance", self.ask("hover", self.place("DISTB", 2))["contents"]["value"])
        label = self.ask("hover", self.place("FA(B)", 3))["contents"]["value"]
        self.assertIn("F(B)=FEAT/POINT,CART,100,0,0,1,0,0", label)
        self.assertIn("line 11", label)
        self.assertIsNone(self.ask("hover", self.place("800")))

    def labels(self, text):
        self.open(text)
        lines = text.split("\n")
        items = self.ask("completion", {"line": len(lines) - 1, "character": len(lines[-1])})
        return [i["label"] for i in items]

    def test_completion(self):
        self.assertIn("PTMEAS", self.labels(LENGTH + "PT"))
        self.assertIn("CIRCLE", self.labels(LENGTH + "F(C)=FEAT/"))
        self.assertIn("INNER", self.labels(LENGTH + "F(C)=FEAT/CIRCLE,"))
        self.assertNotIn("CART", self.labels(LENGTH + "T(C)=TOL/"))
        self.assertEqual(self.labels(LENGTH + "OUTPUT/FA("), ["A", "B"])
        self.assertEqual(self.labels(LENGTH + "OUTPUT/FA(A),TA("), ["LEN"])
        self.assertIn("FA(A)", self.labels(LENGTH + "OUTPUT/"))
        self.assertIn("F(A)", self.labels(LENGTH + "MEAS/POINT,"))
        self.assertIn("S(P)", self.labels(LENGTH + "SNSLCT/"))
        self.assertIn("CART", self.labels(LENGTH + "PTMEAS/$\n  "))
        self.assertIn("machines", self.labels(LENGTH + "$$! ma"))
        self.assertEqual(self.labels(LENGTH + "$$ ma"), [])
        self.assertEqual(self.labels(LENGTH + "TEXT/OPER,'PT"), [])
        self.assertEqual(self.labels(LENGTH + "DECL/REAL,X\n(AGAIN)\nJUMPTO/"), ["(AGAIN)"])
        self.assertIn("M(HOLE)", self.labels(LENGTH + "M(HOLE)=MACRO/U\nENDMAC\nCALL/"))

    def test_outline_and_folding(self):
        self.open(LENGTH)
        names = [s["name"] for s in self.ask("documentSymbol")]
        for name in ("S(P)", "D(R)", "F(A)", "T(LEN)", "MEAS/POINT,F(B),1", "OUTPUT/FA(A),FA(B),TA(LEN)"):
            self.assertIn(name, names)
        for symbol in self.ask("documentSymbol"):
            outer, inner = symbol["range"], symbol["selectionRange"]
            self.assertLessEqual(outer["start"]["character"], inner["start"]["character"])
            self.assertGreaterEqual(outer["end"]["character"], inner["end"]["character"])
        begin = self.place("MEAS/POINT,F(A)")["line"]
        self.assertIn({"startLine": begin, "endLine": begin + 1}, self.ask("foldingRange"))

    def test_formatting(self):
        self.open(LENGTH.replace("PTMEAS/CART,", "ptmeas / cart, "))
        edits = self.ask("formatting", options={"tabSize": 2, "insertSpaces": True})
        self.assertEqual(edits[0]["newText"], LENGTH.replace("PTMEAS", "  PTMEAS"))
        self.assertEqual(edits[0]["range"]["start"], {"line": 0, "character": 0})
        self.open(edits[0]["newText"])
        self.assertEqual(self.ask("formatting", options={}), [])

    def test_what_is_wrong_in_a_module_stands_at_its_call(self):
        module = "$$ touches \u00e4\nF(A)=FEAT/POINT,CART,0,0,0,0,0,1\nMEAS/POINT,F(A),1\n  PTMAES/CART,0,0,0\nENDMES\n"
        found = self.open_beside("DMISMN/'a part with a long name',4.0\nUNITS/MM,ANGDEC\nT(LENGTH)=TOL/DIAM,-.1,.1\nINCLUD/DMIS,'touches'\nENDFIL\n",
                                 touches=module)
        first = [d for d in found if d["code"] == "E0110"][0]
        self.assertEqual(self.pieces([first["range"]]), ["INCLUD/DMIS,'touches'"])
        self.assertIn("touches.dmi, line 4: PTMAES is not a word", first["message"])
        related = first["relatedInformation"][0]["location"]
        self.assertEqual(related, {"uri": self.uri_of("touches.dmi"), "range": {"start": {"line": 3, "character": 2}, "end": {"line": 3, "character": 8}}})
        whole = {"start": {"line": 0, "character": 0}, "end": {"line": 4, "character": 0}}
        self.assertEqual(self.ask("codeAction", range=whole, context={"diagnostics": []}), [])

    def test_what_is_wrong_in_a_macro_of_a_module_stands_at_its_call(self):
        found = self.open_beside("UNITS/MM,ANGDEC\nXTERN\nEXTFIL/DMIS,'macros.dmi'\nENDXTN\nCALL/M(A),5\nCALL/M(A),'t'\nENDFIL\n",
                                 macros="DMISMD/'macros',5.2\nM(A)=MACRO/X\n  GOTO/X,0,0\nENDMAC\nENDFIL\n")
        first = [d for d in found if d["code"] == "E0106"][0]
        self.assertEqual(self.pieces([first["range"]]), ["CALL/M(A),'t'"])
        self.assertIn("macros.dmi, line 3", first["message"])

    def test_names_of_modules(self):
        self.open_beside("DMISMN/'x',4.0\nUNITS/MM,ANGDEC\nINCLUD/DMIS,'macros'\nCALL/M(A),5\nENDFIL\n",
                         macros="$$ moves\nM(A)=MACRO/X\nGOTO/X,0,0\nENDMAC\n")
        place = self.place("CALL/M(A)", 6)
        self.assertEqual(self.hover(place), "```\nM(A)=MACRO/X\nline 2 of macros.dmi\n```")
        self.assertEqual(self.ask("definition", place), {"uri": self.uri_of("macros.dmi"), "range": {"start": {"line": 1, "character": 0}, "end": {"line": 1, "character": 4}}})
        uses = self.ask("references", place, context={"includeDeclaration": True})
        self.assertEqual([u["uri"] for u in uses], [self.uri, self.uri_of("macros.dmi")])
        self.assertEqual([i["label"] for i in self.ask("completion", self.place("CALL/M(A)", 7))], ["A"])
        self.assertIn("which other programs may read", self.answer("prepareRename", place)["error"]["message"])

    def test_hover_claims_nothing_of_names_that_only_a_run_knows(self):
        self.open("DECL/CHAR,5,L\nL=ASSIGN/'A'\nF(A)=FEAT/POINT,CART,0,0,0,0,0,1\nDO/I,1,3\n  F(H@I)=FEAT/POINT,CART,0,0,0,0,0,1\nENDDO\n"
                  "MEAS/POINT,F(@L),1\nPTMEAS/CART,0,0,0\nENDMES\nOUTPUT/FA(H2)\nSNSLCT/SA(STAR)\n")
        self.assertIn("F(@L): computed label", self.hover(self.place("F(@L)")))
        self.assertIn("L=ASSIGN/'A'", self.hover(self.place("F(@L)", 4)))
        self.assertIn("DO/I,1,3", self.hover(self.place("H@I", 3)))
        self.assertIsNone(self.hover(self.place("FA(H2)", 3)))
        self.assertIsNone(self.hover(self.place("SA(STAR)", 3)))
        self.assertIn("computed label", self.answer("prepareRename", self.place("F(@L)"))["error"]["message"])

    def test_declarations_name_variables_alone(self):
        text = "DECL/GLOBAL,REAL,X,A[5]\nDECL/CHAR,20,S\nDECL/REAL,ABC\nA[2]=ASSIGN/A[1]+X\nX=ASSIGN/"
        self.open(text)
        self.assertEqual([s["name"] for s in self.ask("documentSymbol")], ["X", "A", "S", "ABC", "A", "X"])
        self.assertEqual(self.labels(text), ["A", "ABC", "S", "X"])
        self.assertIsNone(self.hover(self.place("REAL", 2)))
        uses = self.ask("references", self.place("A[5]", 1), context={"includeDeclaration": True})
        self.assertEqual([u["range"]["start"] for u in uses], [self.place("A[5]"), self.place("A[2]"), self.place("A[1]")])

    def test_expectations_name_labels(self):
        text = "$$! machines 50 expect FA(A) TA(LEN) u <= 1\n" + LENGTH
        self.open(text)
        uses = self.ask("references", self.place("T(LEN)=", 3), context={"includeDeclaration": True})
        self.assertEqual(self.pieces([u["range"] for u in uses]), ["TA(LEN)", "T(LEN)", "TA(LEN)"])
        self.assertEqual(self.labels(text + "$$! expect "), ["FA(A)", "FA(B)", "TA(LEN)", "accepted"])
        self.assertEqual(self.labels(text + "$$! expect FA(A) "), ["TA(LEN)"])
        self.assertEqual(self.labels(text + "$$! expect TA("), ["LEN"])
        self.assertIn("u95", self.labels(text + "$$! seed 5 expect TA(LEN) occurrence 2 u"))
        self.assertIn("occurrence", self.labels(text + "$$! expect TA(LEN) "))
        self.assertEqual(self.labels(text + "$$! expect TA(LEN) u "), ["<=", ">=", "between"])
        self.assertEqual(self.labels(text + "$$! expect TA(LEN) u between "), [])
        self.assertEqual(self.labels(text + "$$! machine "), [])

    def test_rename_and_highlight(self):
        self.open("$$! expect TA(LEN) u <= 1\n" + LENGTH)
        place = self.place("FA(A)", 4)
        marks = self.ask("documentHighlight", place)
        self.assertEqual(self.pieces([m["range"] for m in marks]), ["F(A)", "F(A)", "FA(A)"])
        self.assertEqual([m["kind"] for m in marks], [3, 2, 2])
        ready = self.ask("prepareRename", place)
        self.assertEqual((self.pieces([ready["range"]]), ready["placeholder"]), (["A"], "A"))
        self.assertEqual(self.rename(place, "LEFT-1"), self.text.replace("(A)", "(LEFT-1)"))
        self.assertEqual(self.rename(self.place("TA(LEN)"), "L"), self.text.replace("(LEN)", "(L)"))
        self.assertIsNone(self.ask("prepareRename", self.place("UNITS")))
        for wrong in ("", "B", "b", "A)", "A,B", "@A", "A" * 65):
            self.assertEqual(self.answer("rename", place, newName=wrong)["error"]["code"], -32803, wrong)
        self.open(LENGTH.replace("(A)", "(" + "A" * 65 + ")"))
        self.assertEqual(self.rename(self.place("AAA"), "A"), LENGTH)

    def test_rename_keeps_to_what_a_name_means(self):
        text = ("UNITS/MM,ANGDEC\nDECL/REAL,X,Y\nX=ASSIGN/1\nM(MOVE)=MACRO/X,'L'\n  Y=ASSIGN/X+1\n  F(X)=FEAT/POINT,CART,X,0,0,0,0,1\n"
                "  F('L')=FEAT/POINT,CART,Y,0,0,0,0,1\n  JUMPTO/(X)\n  (X)\nENDMAC\nCALL/M(MOVE),A,'L'\nCALL/M(MOVE),2,'L'\nF(X)=FEAT/POINT,CART,X,Y,0,0,0,1\n"
                "JUMPTO/(E)\nTEXT/OPER,'E'\n(E)\n")
        self.open(text)
        self.assertEqual(self.rename(self.place("CART,X,Y", 5), "XX"), text.replace("REAL,X", "REAL,XX").replace("X=ASSIGN/1", "XX=ASSIGN/1").replace("CART,X,Y", "CART,XX,Y"))
        self.assertEqual(self.rename(self.place("MACRO/X", 6), "U"), text.replace("MACRO/X", "MACRO/U").replace("ASSIGN/X", "ASSIGN/U").replace("  F(X)=FEAT/POINT,CART,X", "  F(U)=FEAT/POINT,CART,U")
                         .replace("JUMPTO/(X)\n  (X)", "JUMPTO/(U)\n  (U)"))
        self.assertEqual(self.rename(self.place("'L'", 1), "N"), text.replace("MACRO/X,'L'", "MACRO/X,'N'").replace("F('L')", "F('N')"))
        self.assertEqual(self.rename(self.place("JUMPTO/(E)", 8), "END"), text.replace("JUMPTO/(E)\nTEXT/OPER,'E'\n(E)", "JUMPTO/(END)\nTEXT/OPER,'E'\n(END)"))
        self.assertEqual(self.rename(self.place("M(MOVE)"), "GO"), text.replace("M(MOVE)", "M(GO)"))
        self.assertIn("word of the language", self.answer("rename", self.place("Y=ASSIGN"), newName="CART")["error"]["message"])
        self.assertIn("computed label", self.answer("prepareRename", self.place("F(X)"))["error"]["message"])

    def test_rename_is_refused_where_the_compiler_finds_another_meaning(self):
        self.open("DECL/CHAR,5,L\nL=ASSIGN/'A'\n" + LENGTH.replace("OUTPUT/FA(A)", "OUTPUT/FA(@L)"))
        self.assertIn("FA(A) is not defined", self.answer("rename", self.place("F(A)"), newName="C")["error"]["message"])
        self.open_beside("UNITS/MM,ANGDEC\nF(A)=FEAT/POINT,CART,0,0,0,0,0,1\nINCLUD/DMIS,'touches'\n", touches="MEAS/POINT,F(A),1\nPTMEAS/CART,0,0,0,0,0,1\nENDMES\n")
        self.assertIn("F(A) is not defined", self.answer("rename", self.place("F(A)"), newName="C")["error"]["message"])

    def test_requests_that_make_no_sense_are_answered_and_the_server_goes_on(self):
        self.open(LENGTH)
        self.assertEqual(self.server.request("textDocument/nothing")["error"]["code"], -32601)
        self.assertEqual(self.server.request("nothing")["error"]["code"], -32601)
        self.assertEqual(self.server.request("textDocument/hover", {"textDocument": {"uri": "file:///none"}, "position": {"line": 0, "character": 0}})["error"]["code"], -32602)
        self.assertEqual(self.server.request("textDocument/hover", {"textDocument": 5})["error"]["code"], -32602)
        self.server.send(b"{not json")
        self.assertEqual(self.server.receive()["error"]["code"], -32700)
        for wrong in ([1, 2], {"id": 8}, {"id": 8, "method": 5}, 5):
            self.server.send(wrong)
            answer = self.server.receive()
            self.assertEqual((answer["id"], answer["error"]["code"]), (8 if isinstance(wrong, dict) else None, -32600))
        for opening, closing in ((b'{"a":', b"}"), (b"[", b"]")):
            self.server.send(b'{"id":8,"method":"nothing","params":' + 300_000 * opening + b"1" + 300_000 * closing + b"}")
            self.assertEqual(self.server.receive()["error"]["code"], -32600)
        self.server.send({"id": 8, "result": None})
        self.server.notify("$/cancelRequest", {"id": 1})
        self.server.notify("textDocument/didChange", {})
        self.assertIsNone(self.ask("hover", {"line": 99999, "character": 99999}))
        self.assertIsNotNone(self.ask("hover", self.place("PTMEAS", 2)))

    def test_wrong_parameters_are_told_in_words(self):
        self.open(LENGTH)
        document = {"uri": URI}
        for params, words in (({}, "textDocument is missing"), ({"textDocument": 5}, "textDocument.uri is missing"),
                              ({"textDocument": {"uri": 5}}, "textDocument.uri must be a text"), ({"textDocument": document}, "position is missing"),
                              ({"textDocument": document, "position": {"line": 0, "character": -1}}, "position.character must be a whole number that is not negative"),
                              ({"textDocument": document, "position": {"line": 0.5, "character": 0}}, "position.line must be a whole number")):
            error = self.server.request("textDocument/hover", params)["error"]
            self.assertEqual(error["code"], -32602)
            self.assertIn("textDocument/hover: " + words, error["message"])

    def test_the_life_of_a_server(self):
        self.assertEqual(self.capabilities["positionEncoding"], "utf-16")
        self.assertIsNone(self.server.request("shutdown")["result"])
        self.assertEqual(self.server.request("textDocument/hover")["error"]["code"], -32600)
        self.assertEqual(self.server.request("shutdown")["error"]["code"], -32600)
        self.server.notify("exit", {})
        self.assertEqual(self.server.close(), 0)
        other = Server(self.abbe_path)
        self.assertEqual(other.request("shutdown")["error"]["code"], -32002)
        self.assertEqual(other.close(), 1)

    def test_a_broken_frame_ends_the_server_with_a_word(self):
        for frame, words in ((b"Content-Length: 99999999999999\r\n\r\n", "names no length"), (b"Content-Length: abc\r\n\r\n{}", "names no length"),
                             (b"Content-Length: 10\r\n\r\n{}", "ends inside a message of 10 bytes"), (b"garbage\r\n\r\n", "no Content-Length"),
                             (b"Content-Length: 2\r\n", "ends in the header"), (b"x" * 2000, "longer than")):
            done = subprocess.run([self.abbe_path, "lsp"], input=frame, capture_output=True, timeout=20)
            self.assertEqual((done.returncode, done.stdout), (1, b""))
            self.assertIn(words, done.stderr.decode())


if __name__ == "__main__":
    harness.main()
