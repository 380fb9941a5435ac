// Starts the language server of Abbe for DMIS programs. All that the editor shows comes from there.
const vscode = require("vscode");
const { LanguageClient, TransportKind } = require("vscode-languageclient/node");

let client;

exports.activate = () => {
  const command = vscode.workspace.getConfiguration("abbe").get("path", "abbe");
  client = new LanguageClient(
    "abbe",
    "Abbe",
    { command, args: ["lsp"], transport: TransportKind.stdio },
    { documentSelector: [{ language: "dmis" }] }
  );
  return client.start().catch((error) => {
    vscode.window.showErrorMessage(
      `Abbe could not be started as '${command}' (${error.message}). Say in the setting abbe.path where it is.`
    );
  });
};

exports.deactivate = () => client?.stop();
