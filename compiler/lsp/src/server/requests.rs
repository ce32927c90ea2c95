//! Each request with what answers it.

use super::{Refused, Server};
use crate::answers::{
    actions, complete, folds, hierarchy, hints, layout, navigate, rename, select, signature, symbols, tokens,
};
use crate::place::Place;
use crate::project::Analysis;
use crate::uri;
use gen_lsp_types::{
    CodeActionParams, DocumentDiagnosticReport, DocumentRangeFormattingParams, FullDocumentDiagnosticReport,
    InlayHintParams, LspRequestMethod, Position, RelatedFullDocumentDiagnosticReport, RenameParams,
    SelectionRangeParams, SemanticTokens, TextDocumentIdentifier, TextDocumentPositionParams, Uri,
    WorkspaceSymbolParams,
};
use lsp_server::ErrorCode;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value as Json;
use std::path::{Path, PathBuf};

type Answer = Result<Json, Refused>;

impl Server<'_> {
    pub(super) fn answer(&mut self, method: LspRequestMethod<'_>, params: Json) -> Answer {
        use LspRequestMethod as Method;
        match method {
            Method::TextDocumentHover => self.at(params, navigate::hover),
            Method::TextDocumentDefinition => self.at(params, navigate::definition),
            Method::TextDocumentTypeDefinition => self.at(params, navigate::type_definition),
            Method::TextDocumentImplementation => {
                self.at(params, |it, place| Some(navigate::implementations(it, place)))
            }
            Method::TextDocumentReferences => {
                let with_declaration = params["context"]["includeDeclaration"].as_bool().unwrap_or(true);
                self.at(params, |it, place| Some(navigate::references(it, place, with_declaration)))
            }
            Method::TextDocumentDocumentHighlight => self.at(params, |it, place| Some(navigate::highlights(it, place))),
            Method::TextDocumentSignatureHelp => self.at(params, signature::help),
            Method::TextDocumentPrepareCallHierarchy => {
                self.at(params, |it, place| hierarchy::prepare_calls(it, place).map(|it| vec![it]))
            }
            Method::TextDocumentPrepareTypeHierarchy => {
                self.at(params, |it, place| hierarchy::prepare_types(it, place).map(|it| vec![it]))
            }
            Method::CallHierarchyIncomingCalls => {
                self.of_item(&params, |it, place| Some(hierarchy::incoming(it, place)))
            }
            Method::CallHierarchyOutgoingCalls => {
                self.of_item(&params, |it, place| Some(hierarchy::outgoing(it, place)))
            }
            Method::TypeHierarchySupertypes => {
                self.of_item(&params, |it, place| Some(hierarchy::supertypes(it, place)))
            }
            Method::TypeHierarchySubtypes => self.of_item(&params, |it, place| Some(hierarchy::subtypes(it, place))),
            Method::TextDocumentDocumentSymbol => self.file(&params, |it, file| Some(symbols::outline(it, file))),
            Method::TextDocumentFoldingRange => self.file(&params, |it, file| Some(folds::folds(it, file))),
            Method::TextDocumentSemanticTokensFull => {
                self.file(&params, |it, file| Some(SemanticTokens { result_id: None, data: tokens::tokens(it, file) }))
            }
            Method::TextDocumentInlayHint => {
                let within = read::<InlayHintParams>(params.clone())?.range;
                self.file(&params, |it, file| Some(hints::hints(it, file, within)))
            }
            Method::TextDocumentCodeAction => {
                let within = read::<CodeActionParams>(params.clone())?.range;
                let (path, project) = self.document(&params)?;
                let levels = self.projects[project].unit.levels.clone();
                let analysis = self.projects[project].analysis(&self.documents);
                let file = analysis.file(&path);
                json(file.map(|it| actions::actions(analysis, &levels, it, within)))
            }
            Method::TextDocumentSelectionRange => {
                let positions = read::<SelectionRangeParams>(params.clone())?.positions;
                let (path, project) = self.document(&params)?;
                let analysis = self.projects[project].analysis(&self.documents);
                let around = |it: Position| select::around(analysis, analysis.place(&path, it)?);
                json(positions.into_iter().map(around).collect::<Option<Vec<_>>>())
            }
            Method::TextDocumentCompletion => {
                let position = read::<TextDocumentPositionParams>(params.clone())?.position;
                let (path, project) = self.document(&params)?;
                json(complete::complete(&mut self.projects[project], &self.documents, &path, position))
            }
            Method::TextDocumentPrepareRename => {
                let (path, project) = self.document(&params)?;
                let position = read::<TextDocumentPositionParams>(params)?.position;
                let analysis = self.projects[project].analysis(&self.documents);
                let place = analysis.place(&path, position).ok_or_else(|| "there is no name here".to_owned())?;
                json(rename::prepare(analysis, place)?)
            }
            Method::TextDocumentRename => {
                let (path, project) = self.document(&params)?;
                let params: RenameParams = read(params)?;
                let project = &mut self.projects[project];
                let position = params.text_document_position_params.position;
                let place = project.analysis(&self.documents).place(&path, position);
                let place = place.ok_or_else(|| "there is no name here".to_owned())?;
                json(rename::rename(project, &self.documents, place, &params.new_name)?)
            }
            Method::TextDocumentFormatting => {
                let (path, project) = self.document(&params)?;
                let text = self.documents.get(&path).cloned().unwrap_or_default();
                let layout = &self.projects[project].unit.layout;
                json(layout::whole(&path.to_string_lossy(), &text, layout))
            }
            Method::TextDocumentRangeFormatting => {
                let within = read::<DocumentRangeFormattingParams>(params.clone())?.range;
                let (path, project) = self.document(&params)?;
                let text = self.documents.get(&path).cloned().unwrap_or_default();
                let layout = &self.projects[project].unit.layout;
                json(layout::part(&path.to_string_lossy(), &text, layout, within))
            }
            Method::TextDocumentDiagnostic => {
                let path = self.path(&params)?;
                let items = self.problems(&path);
                let full = FullDocumentDiagnosticReport { result_id: None, items };
                let report = RelatedFullDocumentDiagnosticReport {
                    full_document_diagnostic_report: full,
                    ..RelatedFullDocumentDiagnosticReport::default()
                };
                json(DocumentDiagnosticReport::RelatedFullDocumentDiagnosticReport(report))
            }
            Method::WorkspaceSymbol => {
                let query = read::<WorkspaceSymbolParams>(params)?.query;
                let documents = &self.documents;
                let all = self.projects.iter_mut().flat_map(|it| symbols::workspace(it.analysis(documents), &query));
                json(all.collect::<Vec<_>>())
            }
            other => Err(Refused::new(ErrorCode::MethodNotFound, format!("{other} is not supported"))),
        }
    }

    fn path(&self, params: &Json) -> Result<PathBuf, Refused> {
        let document: TextDocumentIdentifier = read(params["textDocument"].clone())?;
        path(&document.uri)
    }

    /// The file that a request is about, and its project.
    fn document(&mut self, params: &Json) -> Result<(PathBuf, usize), Refused> {
        let path = self.path(params)?;
        let project = self.project_of(&path)?;
        Ok((path, project))
    }

    fn file<T: Serialize>(&mut self, params: &Json, answer: impl FnOnce(&Analysis, u16) -> Option<T>) -> Answer {
        let (path, project) = self.document(params)?;
        let analysis = self.projects[project].analysis(&self.documents);
        json(analysis.file(&path).and_then(|it| answer(analysis, it)))
    }

    fn at<T: Serialize>(&mut self, params: Json, answer: impl FnOnce(&Analysis, Place) -> Option<T>) -> Answer {
        let path = self.path(&params)?;
        let position = read::<TextDocumentPositionParams>(params)?.position;
        self.at_position(&path, position, answer)
    }

    /// The same for what an earlier answer named.
    fn of_item<T: Serialize>(&mut self, params: &Json, answer: impl FnOnce(&Analysis, Place) -> Option<T>) -> Answer {
        let item = &params["item"];
        let uri: Uri = read(item["uri"].clone())?;
        let position: Position = read(item["selectionRange"]["start"].clone())?;
        self.at_position(&path(&uri)?, position, answer)
    }

    fn at_position<T: Serialize>(
        &mut self,
        path: &Path,
        position: Position,
        answer: impl FnOnce(&Analysis, Place) -> Option<T>,
    ) -> Answer {
        let project = self.project_of(path)?;
        let analysis = self.projects[project].analysis(&self.documents);
        json(analysis.place(path, position).and_then(|it| answer(analysis, it)))
    }
}

fn path(uri: &Uri) -> Result<PathBuf, Refused> {
    uri::path(uri).ok_or_else(|| Refused::new(ErrorCode::InvalidParams, format!("{uri} is not a file")))
}

fn read<T: DeserializeOwned>(params: Json) -> Result<T, Refused> {
    serde_json::from_value(params).map_err(|it| Refused::new(ErrorCode::InvalidParams, it.to_string()))
}

fn json(value: impl Serialize) -> Answer {
    serde_json::to_value(value).map_err(|it| Refused::new(ErrorCode::InternalError, it.to_string()))
}
