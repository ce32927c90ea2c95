// Staunch in VS Code: the language server of the command, and what the command runs. All that is known of the language is there.

const vscode = require("vscode");
const { Server } = require("./server");
const { provider } = require("./tasks");
const { tests } = require("./tests");
const { showTrace } = require("./trace");

const server = new Server();

function activate(context) {
    context.subscriptions.push(
        vscode.commands.registerCommand("staunch.restart", () => server.restart()),
        vscode.commands.registerCommand("staunch.showTrace", (uri) => showTrace(context, uri)),
        vscode.tasks.registerTaskProvider("staunch", provider),
        vscode.workspace.onDidChangeConfiguration((it) => {
            const isOurs = ["path", "dialect", "arguments"].some((name) => it.affectsConfiguration(`staunch.${name}`));
            if (isOurs) void server.restart();
        }),
    );
    tests(context);
    // Commands do not wait for it.
    void server.restart();
}

function deactivate() {
    return server.stop();
}

module.exports = { activate, deactivate };
