// Starts `staunch lsp`, and starts it again when its settings change.

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");
const command = require("./command");

const FILES = "**/*.{st,iecst,TcPOU,TcGVL,TcDUT,TcIO,TcTLEO,scl,plcproj,L5X}";

// The server sends what is wrong by itself, also in files that depend on a change. Asked for it as well, VS Code would show it twice.
const sent = {
    fillClientCapabilities(capabilities) {
        delete capabilities.textDocument?.diagnostic;
    },
    preInitialize(capabilities) {
        delete capabilities.diagnosticProvider;
    },
    initialize() {},
    getState: () => ({ kind: "static" }),
    clear() {},
};

// What lenses run is on disk, and does not run in a folder that is not trusted.
async function execute(name, args, next) {
    if (!vscode.workspace.isTrusted) {
        void vscode.window.showWarningMessage("The folder is not trusted: its programs do not run.");
        return;
    }
    const changed = vscode.workspace.textDocuments.filter((it) => it.isDirty && it.languageId === "iecst");
    for (const it of changed) await it.save();
    return next(name, args);
}

class Server {
    constructor() {
        this.turn = Promise.resolve();
    }

    // One after another: a change of settings may come while the server starts.
    restart() {
        this.turn = this.turn.then(() => this.stop()).then(() => this.start());
        return this.turn;
    }

    async start() {
        try {
            await command.run(undefined, ["--version"]);
        } catch (error) {
            void command.missing(undefined, error);
            return;
        }
        const args = ["lsp", ...command.common(), ...command.settings().get("arguments", [])];
        const options = { cwd: vscode.workspace.workspaceFolders?.[0]?.uri.fsPath };
        const watchers = [FILES, "**/staunch.toml"].map((it) => vscode.workspace.createFileSystemWatcher(it));
        this.watchers = watchers;
        this.client = new LanguageClient(
            "staunch",
            "Staunch",
            { command: command.executable(), args, options },
            {
                documentSelector: [{ scheme: "file", language: "iecst" }],
                synchronize: { fileEvents: watchers },
                middleware: { executeCommand: execute },
            },
        );
        this.client.registerFeature(sent);
        await this.client.start().catch((error) => vscode.window.showErrorMessage(`Staunch: ${error.message}`));
    }

    async stop() {
        const client = this.client;
        this.client = undefined;
        this.watchers?.forEach((it) => it.dispose());
        // A server that has ended by itself cannot be stopped.
        await client?.stop().catch(() => {});
        await client?.dispose().catch(() => {});
    }
}

module.exports = { Server };
